#pragma once
#include <string>

#include "vibe_hardware/crtk/teleop_mapping.hpp"

namespace vibe::hardware {

/// Whether the arm is ever sent a force: the tissue answers to joints of the scope only.
bool getsForces(const TeleopMapping& mapping);

/// PortConfig::delay of the scope's joints, the largest; 0 where the arm moves none [s]
double largestDelay(const TeleopMapping& mapping);

/// For sentences: 0.0123 s is "12.3 ms".
std::string inMilliseconds(double time);

/// What late measurements mean for a mapping.
struct Lateness {
  std::string key;       ///< of the mapping, to be raised: "delay" or "timeout"; empty: nothing is wrong
  std::string sentence;  ///< what it means and the remedy, after the words "Measurements come ... after their stamps"
};
/// @param age  of a measurement at its arrival, by clocks that agree [s]
Lateness latenessOf(const TeleopMapping& mapping, double age);

}  // namespace vibe::hardware
