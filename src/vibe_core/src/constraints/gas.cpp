#include "constraints/gas.hpp"

#include <algorithm>

namespace vibe {

namespace {
constexpr double kSmallestVolume = 1e-9;
}

double gaugePressure(double amount, double volume) {
  return amount / std::max(volume, kSmallestVolume) - kAmbientPressure;
}

double gasAmount(double gauge_pressure, double volume) {
  return (kAmbientPressure + gauge_pressure) * volume;
}

double insufflate(const GasScene& gas, double amount, double volume, double dt) {
  const double limit = gas.flow_limit * kAmbientPressure * dt;
  const double wanted = gasAmount(gas.regulated_pressure, volume) - amount;
  return amount + std::clamp(wanted, -limit, limit);
}

}  // namespace vibe
