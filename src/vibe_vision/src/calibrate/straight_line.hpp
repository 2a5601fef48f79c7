#pragma once
#include <Eigen/Core>
#include <vector>

namespace vibe::vision {

/// By which a marker must move to show a direction [px].
constexpr double kShortestPath = 20;

/// A line in the image.
struct StraightLine {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit vector

  double along(const Eigen::Vector2d& at) const { return (at - point).dot(direction); }
  /// To the right of the direction, y down.
  double across(const Eigen::Vector2d& at) const {
    return (at - point).dot(Eigen::Vector2d(-direction.y(), direction.x()));
  }

  /// Least squares of the distances; points much further away than most are left out. `point` is near the first point.
  /// @param covariance  if given: of the position across at `point` [px] and the angle [rad]
  /// @throws Error if the points are all near each other
  static StraightLine fit(const std::vector<Eigen::Vector2d>& points, Eigen::Matrix2d* covariance = nullptr);
};

}  // namespace vibe::vision
