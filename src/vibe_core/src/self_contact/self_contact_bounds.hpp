#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

/// Bounds of a moving surface over a step: a ball around the straight path of each vertex, and a cone around the
/// normals of each triangle along these paths. They are larger than necessary, so that most of them hold for several
/// steps; adapt() renews only those that do not.
///
/// Ball of a vertex that moves from x0 to x1, with centre c and radius r: |x0 - c| <= r and |x1 - c| <= r, and with
/// that the whole path, because a ball is convex.
///
/// Cone of a triangle, with unit axis n and width t (a chord of the unit sphere): |m - n| <= t, that is m . n >= 1 -
/// t^2 / 2, for each unit normal m on the way. The area vector at the part s of the way is
///   a(s) = (1 - s)^2 a0 + 2 s (1 - s) a' + s^2 a1,  a0 = u0 x v0,  a' = (u0 x v1 + u1 x v0) / 2,  a1 = u1 x v1,
/// with the edges u and v from the first corner at the start (0) and at the end (1): a positive combination of three
/// vectors, so that a cone that contains these contains a(s) (Provot 1997, "Collision and self-collision handling in
/// cloth model dedicated to design garments"; Tang, Curtis, Yoon, Manocha 2009, "ICCD", section 4).
///
/// A check of all bounds costs a pass over the vertices: where a vertex has moved by no more than d since the last
/// check, a ball with d to spare holds, and a triangle of height h has turned by less than 2 d / h.
class SelfContactBounds {
 public:
  using NodeVectors = std::array<const double*, 3>;  ///< x, y and z of the vertices
  static constexpr std::size_t kConeGroup = 8;       ///< triangles at once, the width of a register in single precision

  struct Cone {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit
    float turn = 0;  ///< width, a chord of the unit sphere; above 1: the normals may point anywhere
  };

  /// @param part   per vertex, number of the part of the surface whose balls are renewed together where that pays
  /// @param slack  radius of the balls of slow vertices [m]
  SelfContactBounds(const std::vector<std::array<int, 3>>& triangles, std::vector<int> part, double slack);

  /// Renews the bounds that do not hold on the paths from `start` to `end`. Bounds of the paths that led to `start`, or
  /// of the point `start`, must have been the last, or `start` and `end` be the same arrays.
  /// @returns false if a position is not finite; then the bounds are not to be used, and the next call renews all
  bool adapt(const NodeVectors& start, const NodeVectors& end);
  /// Whether the next cone of a triangle may be so wide that it is seldom renewed, because it tells nothing anyway.
  void setLoose(int triangle, bool loose) { loose_cone_[triangle] = loose ? 1 : 0; }
  /// The next call of adapt() renews all.
  void reset();

  const std::vector<int>& moved() const { return moved_; }                ///< vertices with a new ball
  const std::vector<int>& turned() const { return turned_; }              ///< triangles with a new cone
  const std::vector<Eigen::Vector3d>& centre() const { return centre_; }  ///< of the balls [m]
  double radius(int vertex) const { return radius_[vertex]; }             ///< of the balls [m]
  const Cone& cone(int triangle) const { return cone_[triangle]; }

 private:
  struct Area;
  static Eigen::Vector3d vectorOf(const NodeVectors& x, int vertex) {
    return {x[0][vertex], x[1][vertex], x[2][vertex]};
  }
  bool allHoldAt(const NodeVectors& end) const;
  bool adaptBalls(const NodeVectors& start, const NodeVectors& end);
  bool listOutside(const NodeVectors& end);
  void addNeighbours(const NodeVectors& start, const NodeVectors& end);
  void moveBall(int vertex, const NodeVectors& start, const NodeVectors& end);
  void adaptCones(const NodeVectors& start, const NodeVectors& end);
  double radiusFor(double length) const;
  Area areaOf(std::size_t first, const std::vector<float>& at) const;
  float turnCone(int triangle, const NodeVectors& start, const NodeVectors& end);

  const StepPolicy& policy_;
  const std::vector<std::array<int, 3>>& triangles_;
  std::vector<int> part_;
  std::vector<char> part_moves_;
  double slack_;
  std::vector<int> moved_, turned_;
  std::vector<Eigen::Vector3d> centre_;
  std::array<std::vector<double>, 3> middle_;    // the centres, by component
  std::vector<double> radius_, radius_squared_;  // of the balls; the latter < 0: to be renewed [m], [m^2]
  std::vector<int> large_balls_;                 // vertices whose ball is large, for a fast path
  std::vector<Cone> cone_;
  std::vector<char> loose_cone_;              // per triangle, see setLoose()
  std::array<std::vector<float>, 3> normal_;  // axes of the cones, by component; in groups of 8, as the next ones
  std::vector<float> turn_, cosine_;          // width of each cone, and the least cosine with the axis in it
  bool any_wide_cone_ = false;
  double max_radius_ = 0;  // of the balls since the last reset [m]
  // How far vertices may move from their ends at the last check (checked_) [m]; < 0: to be checked.
  double safe_move_ = -1;                       // no bound fails
  double ball_safe_move_ = -1;                  // no ball fails
  double cone_safe_move_ = -1;                  // no cone fails
  double farthest_squared_ = 0;                 // largest distance of a vertex from there, squared [m^2]
  std::array<std::vector<double>, 3> checked_;  // by component [m]
  std::vector<float> start_, end_;              // of the paths, four values per vertex [m]
};

}  // namespace vibe
