#pragma once
#include <string>

#include "drive/drive_keys.hpp"

namespace vibe::rviz_plugins {

/// Where a player stands.
struct DriveSituation {
  Joints joints{};
  double closed = 0;     ///< upper limit of the needle driver [m]
  bool gas_on = false;   ///< the insufflator's button is down
  double pressure = 0;   ///< gauge, of the gas [Pa]
  bool touches = false;  ///< the tool touches tissue
  bool holds = false;    ///< the helix holds tissue
  bool needle_loaded = true, needle_on_arm = true;
  unsigned marks = 0;
  unsigned set_bites = 0;    ///< of the set at work
  unsigned sets_tagged = 0;  ///< with a T-tag, not cinched
  unsigned sets_done = 0;    ///< cinched
};

/// The next thing to do, in the order of the first set of sutures.
struct FirstStep {
  int number = 0;    ///< from 1
  std::string text;  ///< one sentence with the key to press
};
constexpr int kFirstSteps = 12;
FirstStep firstStep(const DriveSituation& now);

}  // namespace vibe::rviz_plugins
