#include "suture/capstan.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

double turningAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d in = b - a, out = c - b;
  return math::atan2(in.cross(out).norm(), in.dot(out));
}

double capstanFactor(double friction, double angle) {
  if (!(friction >= 0) || !(angle >= 0))
    throw Error("An eyelet has the friction " + std::to_string(friction) + " and turns the thread by " +
                std::to_string(angle) + " rad: both must be numbers from 0 on.");
  if (friction == 0 || angle == 0) return std::isinf(friction) ? friction : 1;
  return math::exp(friction * angle);
}

}  // namespace vibe
