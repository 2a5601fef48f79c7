#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

class SelfContactMemory;
class ThreadPool;
struct WallApproach;
struct ClosePoints;

/// Self-contact of a shell: an energy during the solution of a step, and a limit on the paths at its end. Equations
/// (18) and (19) of docs/computation.md; numbers are those of the policy, sections "Forces of walls that meet" and
/// "Paths".
///
/// Energy of a pair, a vertex and the point of another wall that is nearest to it on one side:
///   W = A E' t / 2 * e(s),  e(s) = ln(1 - h)^2 / 2,  s = n . (x - y) / t
///   A    area of the vertex at rest [m^2], halved because the vertices of the other wall store the rest
///   E'   modulus of mucosa, wall_softness times that of the wall [Pa]
///   t    mean thickness of the two walls: the two half walls in between are squeezed from t to s t [m]
///   n    unit, from the point y to the vertex x, at the start of the step
///   h    strain 1 - s, which sets in smoothly between s = 1 + wall_onset and 1 - wall_onset
/// e is the energy of a bar in Hencky's logarithmic strain (1928), so that the stiffness grows as s goes to 0; below
/// wall_straight_below e continues on its tangent, and force and energy stay finite in any state. With a constant n the
/// energy is convex and smooth, and a vertex that an iterate moves through the other wall is pushed back.
///
/// Shares. In a valley of the other wall several spots are local minima of the distance. With the distance d_i along
/// the unit vector n_i, the facing f_i (0 to 1) and c_ij = max(0, n_i . n_j), spot i has the part
///   share_i = f_i o_i / (o_i + sum f_j o_j c_ij),  o_i = max(0, 1 - max f_j c_ij (d_i - d_j) / (wall_sharing t))^2
/// of the bar, the sum over j != i and the inner maximum over d_j < d_i. Walls on opposite sides act independently,
/// each spot acts once, and the force of a vertex that moves across the valley is continuous, so that it comes to rest
/// there.
///
/// Squeezed flat. A vertex and the nearest triangle that faces it see neither edges that cross nor a second triangle.
/// Where any spots of two walls (SelfContactClose) are nearer than (1 + wall_onset) wall_core of the wall, a bar of
/// wall_core of its thickness acts in addition, with the modulus of the wall. It resists as far as the minimum distance
/// of paths, so that walls come to rest before they are stopped there. Bars between edges have the square of the sine
/// of the angle between them as a factor: parallel edges are seen from their vertices.
///
/// Friction of a pair with the normal force N at the start of the step, while it slides by the way w:
///   D = mu N psi(w),  psi = w^2 / w0 (1 - w / (3 w0)) for w < w0, w - w0 / 3 beyond,  w0 = wall_sliding_speed * lead
/// (Li et al. 2020, "Incremental Potential Contact", section 5.2). What it dissipates does not depend on the step to
/// first order. Below w0 friction is viscous, so walls in contact come to rest where they would without friction.
///
/// Paths. resolvePenetrations() shortens the straight paths of the nodes over a step so that no two triangles without a
/// common edge pass through each other, whatever the cause of the motion, neighbours in a sharp fold included. What did
/// not cross stays so, and no record of sides is needed.
///
/// Only walls that face each other are in contact: the cosine between the normals of vertex and triangle is below
/// wall_facing_cosine. Parts of the surface within wall_reach along edges, or within two edges, are one wall: sharper
/// folds are below the resolution of the mesh. Only the bars at spots act within it, at most wall_fold_core as thick as
/// the spots are apart at rest, so that a fold comes to rest before it is stopped, at a distance of path_floor_in_wall.
class SelfContact : public EnergyTerm {
 public:
  using NodeVectors = std::array<const double*, 3>;  ///< x, y and z of the nodes

  /// Two points of the surface: a vertex and the point of another wall that is nearest to it on one side, or a spot at
  /// which walls are close.
  struct Pair {
    std::array<int, 4> node;       ///< -1: fewer
    std::array<double, 4> weight;  ///< of the difference of the points = sum of weight * position; sum 0
    Eigen::Vector3d normal;        ///< unit, from the second to the first
    double thickness;              ///< distance at first contact [m]
    double straight_below;         ///< distance over that thickness below which the energy is linear
    double stiffness;              ///< A E' t / 2 [J]
    Eigen::Vector3d away;          ///< from the second to the first point at detect() [m]
    double friction;               ///< force of friction, with the normal force at detect() [N]
    double speed;                  ///< of sliding at detect() [m/s]
  };

  /// @param rest           the middle surface at rest, consistently oriented; its vertices are the nodes [m]
  /// @param thickness      per vertex [m]
  /// @param young_modulus  of the wall [Pa]
  /// @param carried        the wall is moved about as a whole, as by breath; makes a difference for speed only
  /// @throws Error if a triangle refers to a missing vertex, a thickness or the modulus is not positive, or sizes
  ///         differ
  SelfContact(SurfaceMesh rest, std::vector<double> thickness, double young_modulus, bool carried = false);
  ~SelfContact() override;

  /// Finds the possible contacts within a step; call once before the step. The result depends only on the arguments,
  /// not on earlier calls. Allocates only while its buffers grow. If a position is not finite, there are no contacts.
  /// @param reach  expected largest decrease of the distance between two walls in this step [m]
  /// @param x      positions [m]
  /// @param v      velocities [m/s]
  /// @param lead   time from then to the point at which the step evaluates forces [s]
  /// @param pool   null: the calling thread only; the result is the same
  void detect(const NodeVectors& x, const NodeVectors& v, double reach, double lead, ThreadPool* pool = nullptr);

  double evaluate(const double* positions4, float* gradient4) const override;
  /// Adds the stiffness of the pairs of the last detect() that are in contact at the positions, with their normals.
  void addStiffness(const double* positions4, std::vector<StiffnessCoupling>& couplings) const override;

  /// The energy at detect(), from the positions there alone [J].
  double energy() const { return energy_; }
  /// Moves nodes back towards their positions at detect() as far as necessary so that no wall passes through another on
  /// the straight path from there. Walls that were apart at detect() end at least path_floor of the smallest
  /// thickness apart, or path_kept_share of their distance if they were nearer. The velocity of a node moved back is
  /// that of its shortened path, but no faster than before.
  /// @param step  the time since detect() [s]
  /// @returns the nodes moved back
  const std::vector<int>& resolvePenetrations(const MotionView& motion, double step);

  const std::vector<Pair>& pairs() const { return pairs_; }
  /// With which the points of a pair press on each other where they are at detect() [N].
  double normalForce(const Pair& pair) const;
  bool acts() const override { return !pairs_.empty(); }
  int pairCount() const override { return static_cast<int>(pairs_.size()); }
  int searchCount() const;  ///< how often the lists of what may be near had to be renewed

 private:
  bool isStart(const NodeVectors& x, const NodeVectors& v) const;
  static Eigen::Vector3d awayAt(const Pair& pair, const double* positions4);
  static Eigen::Vector3d slidSince(const Pair& pair, const Eigen::Vector3d& away);
  void addPairs();
  void collectApproaches(int vertex, std::size_t first, std::size_t next);
  bool isInReach(int vertex, const WallApproach& approach) const;
  void addPairsOf(int vertex);
  void listReached(int vertex);
  double farBehind(const WallApproach& one) const;
  static double alike(const WallApproach& one, const WallApproach& other);
  bool isSpot(const WallApproach& approach) const;
  double shareAcrossEdge(const WallApproach& approach) const;
  void addPair(int vertex, int triangle, double share);
  void collectFacing(int vertex);
  void addClosePairs(ThreadPool* pool);
  void addClosePair(const ClosePoints& close);
  void finish(Pair& pair);
  double searchDistance() const;
  double meanThickness(int vertex, int triangle, const Eigen::Vector3d& weight) const;
  Eigen::Vector3d areaVector(int triangle) const;
  Eigen::Vector3d ringVector(int vertex) const;
  static double facing(const Eigen::Vector3d& one, const Eigen::Vector3d& other);
  bool startPaths(const MotionView& motion);
  bool shortenPaths();
  void spreadStops();
  void stop(const MotionView& motion, int node, const Eigen::Vector3d& end, double step) const;

  const StepPolicy& policy_;
  SurfaceMesh rest_;
  std::vector<double> thickness_;
  double stiffness_;  // E' [Pa]
  double min_thickness_ = 0, max_thickness_ = 0;
  double close_distance_ = 0;  // from a vertex to what it faces, where they may be close [m]
  std::vector<double> area_;   // per vertex at rest [m^2]
  std::unique_ptr<SelfContactMemory> memory_;
  double reach_ = -1, lead_ = 0;  // of the last detect() [m], [s]
  bool found_ = false;            // whether the positions at the last detect() were finite
  bool speeds_matter_ = false;    // something is near; otherwise memory_->speed is not set
  double energy_ = 0;
  std::vector<Pair> pairs_;
  std::vector<int> stopped_;
};

}  // namespace vibe
