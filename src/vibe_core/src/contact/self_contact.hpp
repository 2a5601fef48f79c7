#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "solver/elastic_body.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

class SelfContactMemory;

/// Walls of a shell that meet: an energy while a step is solved, and paths that end before a wall at its end.
///
/// Energy. Where a vertex comes nearer to another part of the middle surface than the mean t of the two thicknesses,
/// the two half walls between are squeezed from t to the distance d and store the energy of a bar in Hencky's
/// logarithmic strain (1928), per vertex of area A
///   W = A E' t / 2 * ln(s)^2 / 2,  s = d / t,
/// half of A E' t because the other wall's vertices store the rest. E' is a tenth of the wall's modulus: what meets is
/// mucosa, and a stiffness near the wall's own against bending is what the iterations of a step resolve. It stiffens
/// as d goes to 0; below 20 % of t it goes on straight, so that force and energy stay finite in any state.
/// Contact sets in from t + 25 % to t - 25 %, with a continuous stiffness. Within a step d is measured along the way
/// between vertex and triangle at its start: convex, smooth, and a vertex that an iterate puts through the other wall
/// is pushed back. What presses slides against a drag of twice its force per distance and step, which goes with the
/// motion: without it the walls, whose normals change as they slide, would never come to rest.
///
/// Paths. resolvePenetrations() ends the straight paths of the nodes over a step before any vertex, edge or triangle
/// passes through another wall, whatever made them move. So walls that were apart stay apart, and need no memory of
/// sides.
///
/// Only walls that face each other press: the vertex's normal and the triangle's have a cosine below 0.3. Parts of the
/// surface within 2.5 thicknesses or 3 mean edges along edges, or two edges, are one wall, which neither presses on
/// itself nor is kept apart: folds sharper than that are beneath the resolution of the mesh. Walls that are nearer than
/// t at rest touch there. No friction at rest.
class SelfContact : public EnergyTerm {
 public:
  /// A vertex and the triangle of another wall that is nearest to it on one side.
  struct Pair {
    std::array<int, 4> node;  ///< vertex, triangle
    Eigen::Vector3d weight;   ///< barycentric, of the foot
    Eigen::Vector3d normal;   ///< unit, from the foot to the vertex
    double thickness;         ///< distance at which they touch [m]
    double stiffness;         ///< A E' t / 2 [J]
    Eigen::Vector3d away;     ///< from the foot to the vertex at detect() [m]
    double drag;              ///< resists sliding from there within the step [N/m]
  };

  /// @param rest           the middle surface at rest, consistently oriented; its vertices are the nodes [m]
  /// @param thickness      per vertex [m]
  /// @param young_modulus  of the wall [Pa]
  /// @throws Error if a triangle names no vertex, or a thickness or the modulus is not above 0, or sizes differ
  SelfContact(SurfaceMesh rest, std::vector<double> thickness, double young_modulus);
  ~SelfContact() override;

  /// Finds what may meet within the step; call once before it. Depends only on the arguments, not on earlier calls.
  /// Allocates only while its memory grows. A position that is not finite leaves nothing to meet.
  /// @param reach  how much nearer two walls are expected to come in this step [m]
  void detect(const double* x, const double* y, const double* z, double reach);

  double evaluate(const double* positions4, float* gradient4) const override;

  /// Takes nodes back towards where detect() saw them, as far as it needs for no wall to have passed through another on
  /// the straight way from there. Walls that were apart at detect() end at least 5 % of the least thickness apart, or
  /// 90 % of their distance where they were nearer. A node taken back gets the velocity of the way it went.
  /// @param step  the time since detect() [s]
  /// @returns the nodes taken back
  const std::vector<int>& resolvePenetrations(const MotionView& motion, double step);

  const std::vector<Pair>& pairs() const { return pairs_; }
  bool acts() const override { return !pairs_.empty(); }
  int searchCount() const { return searches_; }  ///< detect() calls that could not tell without a search

 private:
  bool start(const double* x, const double* y, const double* z, double& moved);
  void search(double reach);
  void addPairs(double reach);
  void addPair(int near, double facing);
  double meanThickness(int vertex, int triangle) const;
  double facing(int vertex, int triangle) const;
  void findApproaches(bool anew, double distance);
  void update();
  bool endsOf(const double* x, const double* y, const double* z, double& longest);

  SurfaceMesh rest_;
  std::vector<double> thickness_;
  double stiffness_;  // E' [Pa]
  double min_thickness_ = 0, max_thickness_ = 0;
  double ahead_ = 0;          // of where walls press, searched [m]
  std::vector<double> area_;  // per vertex at rest [m^2]
  std::unique_ptr<SelfContactMemory> memory_;
  double cover_ = -1;  // everything nearer than this was found by the last search [m]; < 0: nothing is known
  double moved_ = 0;   // farthest a node had moved since then at detect() [m]
  int searches_ = 0;
  std::vector<Pair> pairs_;
  std::vector<int> stopped_;
};

}  // namespace vibe
