#pragma once

namespace vibe {

/// Whether the gas is at the set point of the insufflator: from within 1 % of it (at least 1 Pa) until it is more than
/// 5 % (at least 5 Pa) away, so that pressure that is disturbed by the tool does not reach the set point again and
/// again. Design choice: a wall that is pushed or drawn in changes the pressure by less than 5 %.
/// @param pressure, set_point  gauge [Pa]
/// @param was                  the answer of the step before
bool isAtSetPoint(double pressure, double set_point, bool was);

}  // namespace vibe
