#pragma once
#include <regex>
#include <string>

#include "vibe_testing/scope_fixture.hpp"

namespace vibe::test {

/// The endoscope's URDF with one capsule as its only collision shape, which reaches forward from the tip, and with
/// another speed limit of the insertion [m/s].
inline std::string thinToolText(double radius, double length, double speed) {
  std::string text = std::regex_replace(scopeText(), std::regex("<collision>[\\s\\S]*?</collision>"), "");
  const auto sphere = [&](double x) {
    return "<collision><origin xyz=\"" + std::to_string(x) + " 0 0\" rpy=\"0 0 0\"/><geometry><sphere radius=\"" +
           std::to_string(radius) + "\"/></geometry></collision>";
  };
  const std::string capsule = "<link name=\"scope_tip\"><collision><origin xyz=\"" + std::to_string(length / 2) +
                              " 0 0\" rpy=\"0 1.57079632679 0\"/><geometry><cylinder radius=\"" +
                              std::to_string(radius) + "\" length=\"" + std::to_string(length) +
                              "\"/></geometry></collision>" + sphere(0) + sphere(length);
  text = std::regex_replace(text, std::regex("<link name=\"scope_tip\">"), capsule);
  return std::regex_replace(text, std::regex("velocity=\"0.15\""), "velocity=\"" + std::to_string(speed) + "\"");
}

}  // namespace vibe::test
