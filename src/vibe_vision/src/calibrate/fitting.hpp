#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "vibe_core/files/number_text.hpp"

namespace vibe::vision {

/// Linear least squares with equal weights, its covariance and its leverages.
struct LinearFit {
  Eigen::VectorXd solution, residual;
  Eigen::VectorXd leverage;    ///< diagonal of the hat matrix
  Eigen::MatrixXd covariance;  ///< scaled by the residuals; zero without a degree of freedom
  int freedom = 0;

  /// Probability of a residual as large as that of `row` if the other rows are right (deleted Studentised residual);
  /// 1 where too few rows remain to tell.
  double deletedTail(Eigen::Index row) const;
};

LinearFit solveLinear(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Probability that the size of a t-distributed number is larger than |t|. @param freedom  degrees of freedom, >= 1
double studentTail(double t, int freedom);
/// The t for which studentTail() is `tail`, (0, 1).
double studentQuantile(double tail, int freedom);

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

/// Of two in the middle the greater. There must be a value.
template <class Number>
Number median(std::vector<Number> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// "a, b and c"
inline std::string listOf(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  return text;
}

inline std::string withDecimals(double value, int decimals) {
  return formatted("%.*f", decimals, value);
}

}  // namespace vibe::vision
