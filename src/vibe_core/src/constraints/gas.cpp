#include "vibe_core/constraints/gas.hpp"

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

GasRange insufflatorRange(const GasScene& gas, double amount, double dt) {
  const double limit = gas.flow_limit * kAmbientPressure * dt;
  return {std::max(0.0, amount - limit), amount + limit};
}

double insufflate(const GasScene& gas, double amount, double volume, double dt) {
  const GasRange range = insufflatorRange(gas, amount, dt);
  return std::clamp(gasAmount(gas.regulated_pressure, volume), range.min, range.max);
}

}  // namespace vibe
