#pragma once
#include "vibe_core/scene/scene.hpp"

namespace vibe {

constexpr double kAmbientPressure = 101325;  ///< of the surroundings, absolute [Pa]

/// Gauge pressure of an isothermal gas [Pa].
/// @param amount  absolute pressure times volume [J]
/// @param volume  of the lumen [m^3]; below a cubic millimetre it counts as that
double gaugePressure(double amount, double volume);

/// Amount that gives a gauge pressure in a volume [J].
double gasAmount(double gauge_pressure, double volume);

/// Amount after the insufflator has worked for `dt` towards its set point, in or out, within its flow limit [J].
double insufflate(const GasScene& gas, double amount, double volume, double dt);

}  // namespace vibe
