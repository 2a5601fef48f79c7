#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "vibe_sim/geometry/surface_mesh.hpp"
#include "vibe_sim/solver/energy_term.hpp"

namespace vibe {

class SelfContactSearch;
struct TriangleFoot;

/// Walls of a shell that meet. Where a vertex comes nearer to another part of the middle surface than the mean t of
/// the two thicknesses, the two half walls between are squeezed from t to the distance d and store the energy of a bar
/// in Hencky's logarithmic strain (1928), per vertex of area A
///   W = A E t / 2 * ln(s)^2 / 2,  s = d / t,
/// half of A E t because the other wall's vertices store the rest. It resists without bound as d goes to 0; below 5 %
/// of t it goes on straight, so that force and energy stay finite in any state. Contact sets in over the last 5 % above
/// and below t, with a continuous stiffness.
///
/// Only walls that face each other count: the vertex's normal and the triangle's have a cosine below 0.3. Parts of the
/// surface within 2.5 thicknesses along edges, or two edges, are one wall. Walls that are nearer than t at rest touch
/// there. No friction.
///
/// Limits: vertices are kept from triangles, not edges from edges, so edges longer than about 2 thicknesses can cross
/// where both walls are sharply folded. The side of a vertex is the one found by detect(): walls that have already
/// passed through each other there stay so.
class SelfContact : public EnergyTerm {
 public:
  /// A vertex and the triangles of one wall, before (side 1) or behind (side -1) which it lies.
  struct Pair {
    int vertex;
    double side;
    double thickness;  ///< distance at which they touch [m]
    double stiffness;  ///< A E t / 2 [J]
    int first, count;  ///< range of nearTriangles()
  };
  struct NearTriangle {
    int triangle;
    double distance;  ///< at detect() [m]
  };

  /// @param rest           the middle surface at rest, consistently oriented; its vertices are the nodes [m]
  /// @param thickness      per vertex [m]
  /// @param young_modulus  of the wall across its thickness [Pa]
  /// @throws Error if a triangle names no vertex, or a thickness or the modulus is not above 0, or sizes differ
  SelfContact(SurfaceMesh rest, std::vector<double> thickness, double young_modulus);
  ~SelfContact() override;

  /// Finds what may meet within the step; call once before it. Depends only on the arguments, not on earlier calls.
  /// Allocates only while its memory grows. A position that is not finite leaves nothing to meet.
  /// @param reach  how much nearer two walls may come in this step, twice the farthest move of a node [m]: limitMove
  ///               keeps every node within 0.38 * (least thickness + reach) of the positions given here
  void detect(const double* x, const double* y, const double* z, double reach);

  double evaluate(const double* positions4, float* gradient4) const override;

  /// A node of a pair moves by at most 0.4 of what the gap has above a quarter of its width at detect(); a
  /// generalised-alpha step ends up to 1.25 times as far as its iterations go (spectral radius up to 0.25) and still
  /// passes nothing. Nodes that part may move by 5 % of the thickness however narrow the gap. Not for two threads at
  /// once.
  void limitMove(const double* positions4, float* move4) const override;

  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<NearTriangle>& nearTriangles() const { return near_; }
  int searchCount() const { return searches_; }  ///< detect() calls that could not tell without a search

 private:
  bool follow(const double* x, const double* y, const double* z, double& moved_squared);
  void search(double reach);
  void addPairs(int vertex, double reach);
  void addPair(int vertex, double side, const std::vector<NearTriangle>& found, double reach);
  double meanThickness(int vertex, int triangle) const;
  double farthestMove(const double* positions4) const;
  double addSqueeze(const Pair& pair, const std::array<int, 3>& triangle, const TriangleFoot& foot,
                    const double* positions4, float* gradient4) const;
  void limitPairs(const double* positions4, const float* move4) const;
  void restrict(int node, double room, double floor, const Eigen::Vector3d& apart, const float* move4) const;

  SurfaceMesh rest_;
  std::vector<double> thickness_;
  double young_modulus_;
  double least_thickness_ = 0, most_thickness_ = 0;
  std::vector<double> area_;  // per vertex at rest [m^2]
  std::unique_ptr<SelfContactSearch> search_;
  std::vector<Eigen::Vector3d> start_;     // positions of the last detect()
  std::vector<Eigen::Vector3d> searched_;  // positions of the last search
  double margin_ = -1;  // how much nearer than touching anything was at the last search; < 0: unknown
  double steady_ = 0;   // farthest a node may have moved since for margin_ to hold [m]
  int searches_ = 0;
  std::vector<Pair> pairs_;
  std::vector<NearTriangle> near_;
  std::vector<NearTriangle> found_[2];  // of one vertex: behind, before
  std::vector<double> range_;           // how far each node may move from start_ [m]
  mutable std::vector<double> room_;    // how far each node may move in one iteration [m]
};

}  // namespace vibe
