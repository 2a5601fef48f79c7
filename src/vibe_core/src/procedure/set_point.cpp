#include "procedure/set_point.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

constexpr double kReached = 0.01, kLost = 0.05;  // parts of the set point
constexpr double kMinReached = 1, kMinLost = 5;  // of low set points [Pa]

}  // namespace

bool isAtSetPoint(double pressure, double set_point, bool was) {
  const double part = was ? kLost : kReached, min = was ? kMinLost : kMinReached;
  return std::abs(pressure - set_point) < std::max(min, part * std::abs(set_point));
}

}  // namespace vibe
