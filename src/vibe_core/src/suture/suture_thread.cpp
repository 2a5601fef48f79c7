#include "vibe_core/suture/suture_thread.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {
constexpr double kNewtonsPerKilogramForce = 9.80665;
}  // namespace

double ThreadMaterial::crossSection() const {
  return 0.25 * kPi * diameter * diameter;
}

double ThreadMaterial::massPerLength() const {
  return density * crossSection();
}

double ThreadMaterial::weightPerLength(double gravity) const {
  return massPerLength() * gravity;
}

double ThreadMaterial::axialStiffness() const {
  return elastic_modulus * crossSection();
}

ThreadMaterial polypropylene20() {
  ThreadMaterial thread;
  thread.diameter = 0.5 * (0.300e-3 + 0.339e-3);
  thread.density = 905;
  thread.elastic_modulus = 4.026e9;
  thread.breaking_force = 1.44 * kNewtonsPerKilogramForce;
  thread.tissue_friction = 0.15;
  return thread;
}

namespace {

/// Below this fraction of the length the ends count as one above the other.
constexpr double kVertical = 1e-14;

/// ln(sinh(u) / u), accurate to rounding from 0 (where it is u^2 / 6) to where sinh would overflow.
double logSinhRatio(double u) {
  if (u > 1) return u - math::log(2 * u) + math::log1p(-math::exp(-2 * u));
  const double z = u * u;
  const double rest = 1 + z / 42 * (1 + z / 72 * (1 + z / 110 * (1 + z / 156 * (1 + z / 210))));
  return math::log1p(z / 6 * (1 + z / 20 * rest));
}

double logSinhRatioSlope(double u) {
  return u < 0.02 ? u / 3 - u * u * u / 45 : 1 / math::tanh(u) - 1 / u;
}

/// Solves sinh(u) / u = 1 + excess for u. ln(sinh(u) / u) is convex and sinh(u) / u >= 1 + u^2 / 6, so Newton's method
/// converges from sqrt(6 excess) down to the root without overshooting. The bounds guard only against rounding.
double solveSinhRatio(double excess) {
  const double target = math::log1p(excess);
  double u = std::sqrt(6 * excess);
  const double min = std::min(u, std::sqrt(6 * target));  // because ln(sinh(u) / u) <= u^2 / 6
  for (int i = 0; i < 60 && u > 0; ++i) {
    const double next = std::max(min, u - (logSinhRatio(u) - target) / logSinhRatioSlope(u));
    if (!(std::abs(next - u) > 1e-16 * u)) break;
    u = next;
  }
  return u;
}

/// The coordinate axis most nearly perpendicular to a vector, made exactly perpendicular: a sag direction without
/// gravity.
Eigen::Vector3d anyDirectionSquareTo(const Eigen::Vector3d& vector) {
  const double norm = vector.stableNorm();
  if (norm == 0) return -Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d unit = vector / norm;
  int axis = 0;
  unit.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
  return (direction - unit * unit.dot(direction)).normalized();
}

void checkCatenary(bool right, const char* what, const char* remedy) {
  if (!right) throw Error(std::string("A hanging thread was given ") + what + ": " + remedy + ".");
}

/// Fills scale and lowest of a thread that is longer than the distance of its ends.
/// @param level, rise  of the last end relative to the first, as fractions of the length
/// @param spare        1 - (distance / length)^2
void shape(double level, double rise, double spare, Catenary& thread) {
  if (level <= kVertical) {
    thread.scale = 0;
    thread.lowest = 0.5 * thread.length * (1 - rise);
    return;
  }
  // sinh(u) / u = sqrt(1 - rise^2) / level = r and r^2 - 1 = spare / level^2, written without cancellation.
  const double square_excess = spare / (level * level);
  const double u = solveSinhRatio(square_excess / (1 + std::sqrt(1 + square_excess)));
  thread.scale = thread.length * level / (2 * u);
  thread.lowest = 0.5 * thread.length * (1 - rise / math::tanh(u));
}

}  // namespace

double Catenary::tension(double arc_length) const {
  return taut ? 0 : weight * math::hypot(scale, arc_length - lowest);
}

Eigen::Vector3d Catenary::point(double arc_length) const {
  const double s = std::clamp(arc_length, 0.0, length);
  if (taut) return length > 0 ? Eigen::Vector3d(first + (last - first) * (s / length)) : first;
  const double from = -lowest, to = s - lowest;  // vertical force over weight, at the first end and at s
  const double first_pull = math::hypot(scale, from), pull = math::hypot(scale, to);
  const double height = s == 0 ? 0 : s * ((from + to) / (first_pull + pull));
  double way = 0;
  if (scale > 0) {
    // asinh(to / scale) - asinh(from / scale) as one asinh, to avoid cancellation in a nearly straight thread.
    const double p = to / scale, q = from / scale, hyp_p = pull / scale, hyp_q = first_pull / scale;
    const double sum = p * hyp_q + q * hyp_p;
    const double argument = p * q > 0 ? (p - q) * (p + q) / sum : p * hyp_q - q * hyp_p;
    way = scale * math::asinh(argument);
  } else if (to > 0) {
    way = (last - first).dot(across);
  }
  return first + up * height + across * way;
}

Eigen::Vector3d Catenary::lowestPoint() const {
  if (taut) return (last - first).dot(up) < 0 ? last : first;
  return point(lowest);
}

Catenary hang(const Eigen::Vector3d& first, const Eigen::Vector3d& last, double length, double weight_per_length,
              const Eigen::Vector3d& gravity_direction) {
  const Eigen::Vector3d between = last - first;
  checkCatenary(first.allFinite() && last.allFinite() && between.allFinite(), "an end that is not a finite position",
                "check what holds the thread");
  checkCatenary(std::isfinite(length) && length >= 0, "a length that is not a number from 0 on", "give metres");
  checkCatenary(std::isfinite(weight_per_length) && weight_per_length >= 0, "a weight that is not a number from 0 on",
                "give newtons per metre");
  checkCatenary(gravity_direction.allFinite(), "a direction of gravity that is not finite",
                "give three finite numbers");

  const double gravity = gravity_direction.stableNorm();
  const double distance = between.stableNorm();
  Catenary thread;
  thread.first = first;
  thread.last = last;
  thread.length = length;
  thread.weight = gravity > 0 ? weight_per_length : 0;
  thread.up = gravity > 0 ? Eigen::Vector3d(-(gravity_direction / gravity).normalized())
                          : Eigen::Vector3d(-anyDirectionSquareTo(between));
  thread.taut = length <= distance * (1 + 4 * std::numeric_limits<double>::epsilon());
  thread.scale = 0;
  thread.lowest = 0;
  thread.across.setZero();
  if (thread.taut) return thread;

  const Eigen::Vector3d share = between / length;
  const double rise = share.dot(thread.up);
  const Eigen::Vector3d level = share - thread.up * rise;
  const double level_share = level.stableNorm();
  if (level_share > 0) thread.across = level / level_share;
  const double spare = (length - distance) / length * ((length + distance) / length);
  shape(level_share, rise, spare, thread);
  return thread;
}

}  // namespace vibe
