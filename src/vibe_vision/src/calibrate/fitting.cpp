#include "calibrate/fitting.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {

double studentTail(double t, int freedom) {
  return 2 * cdf(complement(boost::math::students_t(freedom), std::abs(t)));
}

double studentQuantile(double tail, int freedom) {
  return quantile(complement(boost::math::students_t(freedom), tail / 2));
}

double LinearFit::deletedTail(Eigen::Index row) const {
  const double free = 1 - leverage(row);
  if (freedom < 2 || free < 1e-9) return 1;
  const double r2 = residual(row) * residual(row) / free;
  const double others = residual.squaredNorm() - r2;  // sum of squares without the row
  constexpr double kRounding = 1e-8;                  // [px]; what exact data leave
  const double variance = std::max(others, kRounding * kRounding) / (freedom - 1);
  return studentTail(std::sqrt(r2 / variance), freedom - 1);
}

LinearFit solveLinear(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  LinearFit fit;
  // columns of one size: slides are small in metres, their images large in pixels
  const Eigen::VectorXd scale = a.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = a * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse =
      (scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(a.cols(), a.cols()));
  fit.solution = scale.cwiseInverse().asDiagonal() * (inverse * (scaled.transpose() * b));
  fit.residual = b - a * fit.solution;
  fit.leverage = (scaled * inverse).cwiseProduct(scaled).rowwise().sum();
  fit.freedom = static_cast<int>(a.rows() - a.cols());
  const double variance = fit.freedom > 0 ? fit.residual.squaredNorm() / fit.freedom : 0;
  fit.covariance = variance * (scale.cwiseInverse().asDiagonal() * inverse * scale.cwiseInverse().asDiagonal());
  return fit;
}

namespace {

constexpr double kFar = 5 * 1.4826;      // times the median distance: 5 standard deviations
constexpr double kSmallestLimit = 0.02;  // nearer points always count [px]

double medianDistance(const StraightLine& line, const std::vector<Eigen::Vector2d>& points) {
  std::vector<double> distances;
  for (const Eigen::Vector2d& point : points) distances.push_back(std::abs(line.across(point)));
  return median(distances);
}

/// Of the lines through two points the one that is nearest to most: it does not mind a few points elsewhere.
StraightLine roughLine(const std::vector<Eigen::Vector2d>& points) {
  StraightLine best;
  double longest = 0, nearest = 1e300;
  const std::size_t step = 1 + points.size() / 40;  // pairs enough
  for (std::size_t i = 0; i < points.size(); i += step) {
    for (std::size_t j = i + 1; j < points.size(); j += step) {
      const double length = (points[j] - points[i]).norm();
      longest = std::max(longest, length);
      if (length < kShortestPath) continue;
      const StraightLine line{points[i], (points[j] - points[i]) / length};
      const double distance = medianDistance(line, points) + 1e-3 / length;  // of equal ones the longest
      if (distance < nearest) nearest = distance, best = line;
    }
  }
  if (longest >= kShortestPath) return best;
  throw Error(std::string("the marker moved by ") + formatted("%.1f", longest) +
              " px only; move the instrument over its whole range");
}

}  // namespace

StraightLine StraightLine::fit(const std::vector<Eigen::Vector2d>& points, Eigen::Matrix2d* covariance) {
  constexpr int kIterations = 10;
  StraightLine line = roughLine(points);
  LinearFit fit;
  for (int i = 0; i < kIterations; ++i) {
    const double limit = std::max(kFar * medianDistance(line, points), kSmallestLimit);
    std::vector<Eigen::Vector2d> near;
    for (const Eigen::Vector2d& point : points)
      if (std::abs(line.across(point)) <= limit) near.push_back(point);
    Eigen::MatrixXd a(static_cast<Eigen::Index>(near.size()), 2);
    Eigen::VectorXd b(a.rows());
    line.point += line.along(points.front()) * line.direction;
    for (Eigen::Index row = 0; row < a.rows(); ++row) {
      a.row(row) << 1, line.along(near[static_cast<std::size_t>(row)]);
      b(row) = line.across(near[static_cast<std::size_t>(row)]);
    }
    fit = solveLinear(a, b);
    const Eigen::Vector2d n(-line.direction.y(), line.direction.x());
    line.point += fit.solution(0) * n;
    line.direction = (line.direction + fit.solution(1) * n).normalized();
  }
  if (covariance != nullptr) *covariance = fit.covariance;
  return line;
}

}  // namespace vibe::vision
