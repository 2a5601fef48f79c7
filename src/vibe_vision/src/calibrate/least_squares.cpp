#include "calibrate/least_squares.hpp"

#include <algorithm>
#include <cmath>

#include "calibrate/student_t.hpp"

namespace vibe::vision {

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

}  // namespace vibe::vision
