#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace vibe {

/// Bounds of a moving surface over a step: a ball around the straight path of each vertex, and a cone around the
/// normals of each triangle along these paths. They are larger than necessary, so that most of them hold for several
/// steps; adapt() renews only those that do not.
class SelfContactBounds {
 public:
  using NodeVectors = std::array<const double*, 3>;  ///< x, y and z of the vertices

  struct Cone {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit
    float turn = 0;  ///< largest distance of the unit normals from it [1]; above 1: they may point anywhere
  };

  /// @param part   per vertex, number of the part of the surface whose balls are renewed together, as far as it is
  /// worth
  /// @param slack  radius of the balls of slow vertices [m]
  SelfContactBounds(const std::vector<std::array<int, 3>>& triangles, std::vector<int> part, double slack);

  /// Renews the bounds that do not hold on the paths from `start` to `end`. Bounds of the paths that led to `start`, or
  /// of the point `start`, must have been the last, or `start` and `end` be the same arrays.
  /// @returns false if a position is not finite; then the bounds are not to be used, and the next call renews all
  bool adapt(const NodeVectors& start, const NodeVectors& end);
  /// Whether the next cone of a triangle may be so wide that it is seldom renewed.
  void setCoarse(int triangle, bool coarse) { coarse_[triangle] = coarse ? 1 : 0; }
  /// The next call of adapt() renews all.
  void reset();

  const std::vector<int>& moved() const { return moved_; }                ///< vertices with a new ball
  const std::vector<int>& turned() const { return turned_; }              ///< triangles with a new cone
  const std::vector<Eigen::Vector3d>& centre() const { return centre_; }  ///< of the balls [m]
  double radius(int vertex) const { return radius_[vertex]; }             ///< of the balls [m]
  const Cone& cone(int triangle) const { return cone_[triangle]; }

 private:
  struct Area;
  bool holdAll(const NodeVectors& end) const;
  bool adaptBalls(const NodeVectors& start, const NodeVectors& end);
  void addNeighbours(const NodeVectors& start, const NodeVectors& end);
  void moveBall(int vertex, const NodeVectors& start, const NodeVectors& end);
  void adaptCones(const NodeVectors& start, const NodeVectors& end);
  double radiusFor(double length) const;
  Area areaOf(std::size_t first, const std::vector<float>& at) const;
  float turnCone(int triangle, const NodeVectors& start, const NodeVectors& end);

  const std::vector<std::array<int, 3>>& triangles_;
  std::vector<int> part_;
  std::vector<char> part_moves_;
  double slack_;
  std::vector<int> moved_, turned_;
  std::vector<Eigen::Vector3d> centre_;
  std::array<std::vector<double>, 3> middle_;  // the same, by component
  std::vector<double> radius_, square_;        // of the balls, and their squares; < 0: to be renewed [m], [m^2]
  std::vector<int> wide_;                      // vertices with a large ball, for a fast path
  std::vector<Cone> cone_;
  std::vector<char> coarse_;                  // whether, per triangle
  std::array<std::vector<float>, 3> normal_;  // of the cones, by component; in groups of 8, as the next ones
  std::vector<float> turn_, cosine_;          // of the cones: their width, and the least cosine with the normal in them
  bool any_wide_cone_ = false;
  double max_radius_ = 0;   // of the balls since the last reset [m]
  double ball_spare_ = -1;  // no ball fails while its vertex moves by less [m]
  double holds_ = -1;    // no bound fails while all vertices are nearer to their ends at the last check; < 0: check [m]
  double farthest_ = 0;  // square of the largest distance of a vertex from there [m^2]
  double still_ = -1;    // vertices may be so far from their ends at the last check of the normals; < 0: check [m]
  std::array<std::vector<double>, 3> checked_;  // these ends [m]
  std::vector<float> start_, end_;              // of the paths, four values per vertex [m]
};

}  // namespace vibe
