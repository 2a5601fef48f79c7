#pragma once

#include "vibe_core/scene/scene.hpp"
#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// Gauge pressure of an isothermal gas [Pa].
/// @param amount  absolute pressure times volume [J]
/// @param volume  of the lumen [m^3]; below kSmallestVolume it counts as that
double gaugePressure(double amount, double volume);

/// Amount that gives a gauge pressure in a volume [J].
double gasAmount(double gauge_pressure, double volume);

/// What an insufflator may reach in a step.
struct GasRange {
  double min = 0;  ///< of the amount [J]
  double max = 0;  ///< of the amount [J]
};

/// Amounts between which the insufflator may be after `dt`, in or out, within its flow limit.
GasRange insufflatorRange(const GasScene& gas, double amount, double dt);

/// Amount after the insufflator has worked for `dt` towards its set point in a volume, within its range [J].
double insufflate(const GasScene& gas, double amount, double volume, double dt);

}  // namespace vibe
