#include "geometry/ball_union.hpp"

#include <algorithm>
#include <cmath>

#include "common/elementary.hpp"

namespace vibe {

namespace {

constexpr int kProjectionSteps = 8;
constexpr double kTolerance = 1e-8;    // [m]
constexpr double kNegligible = -36.0;  // exponent below the resolution of a double

}  // namespace

void BallUnion::add(const Eigen::Vector3d& centre, double radius, double spacing) {
  // the integral of exp(-sqrt(r^2 + s^2) / k) over the row is about exp(-r / k) sqrt(2 pi k r)
  balls_.push_back({centre, radius, spacing / std::sqrt(2.0 * M_PI * blend_ * radius)});
}

double BallUnion::evaluate(const Eigen::Vector3d& p, Eigen::Vector3d* gradient) const {
  // shift by the nearest ball, so that the exponentials neither overflow nor all underflow far away
  double shift = -1e300;
  for (const auto& ball : balls_) shift = std::max(shift, ball.radius - offset(p, ball).norm());
  double sum = 0.0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (const auto& ball : balls_) {
    const Eigen::Vector3d d = offset(p, ball);
    const double distance = d.norm();
    const double exponent = (ball.radius - distance - shift) / blend_;
    if (exponent < kNegligible) continue;
    const double weight = ball.weight * math::exp(exponent);
    sum += weight;
    if (gradient && distance > 0.0) slope += weight / distance * d;
  }
  if (gradient) *gradient = Eigen::Vector3d(slope.x() / flattening_, slope.y(), slope.z()) / sum;
  return -shift - blend_ * math::log(sum);
}

Eigen::Vector3d BallUnion::offset(const Eigen::Vector3d& p, const Ball& ball) const {
  return {(p.x() - ball.centre.x()) / flattening_, p.y() - ball.centre.y(), p.z() - ball.centre.z()};
}

double BallUnion::value(const Eigen::Vector3d& p) const {
  return evaluate(p, nullptr);
}

Eigen::Vector3d BallUnion::project(const Eigen::Vector3d& p) const {
  Eigen::Vector3d x = p, gradient;
  for (int k = 0; k < kProjectionSteps; ++k) {
    const double f = evaluate(x, &gradient);
    if (std::abs(f) < kTolerance || gradient.squaredNorm() == 0.0) break;
    x -= f / gradient.squaredNorm() * gradient;
  }
  return x;
}

}  // namespace vibe
