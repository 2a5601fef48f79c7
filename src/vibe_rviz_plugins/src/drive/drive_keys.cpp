#include "drive/drive_keys.hpp"

#include <qnamespace.h>

#include <algorithm>

namespace vibe::rviz_plugins {
namespace {

enum Button : int { ApcPedal, HelixGrab, Needle, TTag, Cinch, Insufflate };

}  // namespace

const std::array<std::string, kJointCount>& driveJointNames() {
  static const std::array<std::string, kJointCount> names = {
      "insertion", "rotation", "tip_up_down", "tip_left_right", "helix_advance", "helix_rotation", "needle_driver"};
  return names;
}

const std::vector<KeyBinding>& keyBindings() {
  using Kind = KeyBinding::Kind;
  static const std::vector<KeyBinding> all = {
      {Qt::Key_W, Kind::Joint, Insertion, 1},
      {Qt::Key_S, Kind::Joint, Insertion, -1},
      {Qt::Key_A, Kind::Joint, Rotation, -1},  // positive is clockwise for the one who looks along the scope
      {Qt::Key_D, Kind::Joint, Rotation, 1},
      {Qt::Key_Up, Kind::Joint, TipUpDown, 1},
      {Qt::Key_Down, Kind::Joint, TipUpDown, -1},
      {Qt::Key_Left, Kind::Joint, TipLeftRight, 1},
      {Qt::Key_Right, Kind::Joint, TipLeftRight, -1},
      {Qt::Key_E, Kind::Joint, HelixAdvance, 1},
      {Qt::Key_Q, Kind::Joint, HelixAdvance, -1},
      {Qt::Key_X, Kind::Joint, HelixRotation, 1},
      {Qt::Key_Z, Kind::Joint, HelixRotation, -1},
      {Qt::Key_Y, Kind::Joint, HelixRotation, -1},  // where German keyboards have the Z of English ones
      {Qt::Key_R, Kind::Joint, NeedleDriver, 1},
      {Qt::Key_F, Kind::Joint, NeedleDriver, -1},
      {Qt::Key_Space, Kind::Button, ApcPedal, 0},
      {Qt::Key_G, Kind::Button, HelixGrab, 0},
      {Qt::Key_N, Kind::Button, Needle, 0},
      {Qt::Key_T, Kind::Button, TTag, 0},
      {Qt::Key_C, Kind::Button, Cinch, 0},
      {Qt::Key_I, Kind::Button, Insufflate, 0},
      {Qt::Key_1, Kind::Gear, static_cast<int>(DriveGear::Slow), 0},
      {Qt::Key_2, Kind::Gear, static_cast<int>(DriveGear::Normal), 0},
      {Qt::Key_3, Kind::Gear, static_cast<int>(DriveGear::Fast), 0},
      {Qt::Key_Shift, Kind::SlowDown, 0, 0},
  };
  return all;
}

const KeyBinding* findBinding(int key) {
  const auto& all = keyBindings();
  const auto found = std::find_if(all.begin(), all.end(), [key](const KeyBinding& each) { return each.key == key; });
  return found == all.end() ? nullptr : &*found;
}

const std::vector<KeyRow>& keyRows() {
  static const std::vector<KeyRow> rows = {
      {{{Qt::Key_W, "W"}, {Qt::Key_S, "S"}}, "in, out (wheel)"},
      {{{Qt::Key_A, "A"}, {Qt::Key_D, "D"}}, "rotate left, right"},
      {{{Qt::Key_Up, "↑"}, {Qt::Key_Down, "↓"}, {Qt::Key_Left, "←"}, {Qt::Key_Right, "→"}}, "bend tip (drag)", true},
      {{{Qt::Key_Space, "Space"}}, "argon beam (hold)"},
      {{{Qt::Key_I, "I"}}, "gas on, off", true},
      {{{Qt::Key_E, "E"}, {Qt::Key_Q, "Q"}}, "helix out, in"},
      {{{Qt::Key_G, "G"}}, "helix grab, release"},
      {{{Qt::Key_X, "X"}, {Qt::Key_Z, "Z"}}, "turn helix in, back", true},
      {{{Qt::Key_R, "R"}, {Qt::Key_F, "F"}}, "close, open arm"},
      {{{Qt::Key_N, "N"}}, "pass the needle"},
      {{{Qt::Key_T, "T"}}, "drop the T-tag"},
      {{{Qt::Key_C, "C"}}, "cinch (hold)", true},
      {{{Qt::Key_Shift, "Shift"}}, "slow (hold)"},
      {{{Qt::Key_1, "1"}, {Qt::Key_2, "2"}, {Qt::Key_3, "3"}}, "slow, normal, fast", true},
      {{{Qt::Key_V, "V"}}, "next view"},
      {{{Qt::Key_H, "H"}, {Qt::Key_Escape, "Esc"}}, "hide help, leave"},
  };
  return rows;
}

}  // namespace vibe::rviz_plugins
