#include "vibe_operator/drive/drive_keys.hpp"

#include <algorithm>

namespace vibe::operating {

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
      {'W', Kind::Joint, Insertion, 1},
      {'S', Kind::Joint, Insertion, -1},
      {'A', Kind::Joint, Rotation, -1},  // positive is clockwise for the one who looks along the scope
      {'D', Kind::Joint, Rotation, 1},
      {keys::kUp, Kind::Joint, TipUpDown, 1},
      {keys::kDown, Kind::Joint, TipUpDown, -1},
      {keys::kLeft, Kind::Joint, TipLeftRight, 1},
      {keys::kRight, Kind::Joint, TipLeftRight, -1},
      {'E', Kind::Joint, HelixAdvance, 1},
      {'Q', Kind::Joint, HelixAdvance, -1},
      {'X', Kind::Joint, HelixRotation, 1},
      {'Z', Kind::Joint, HelixRotation, -1},
      {'Y', Kind::Joint, HelixRotation, -1},  // where German keyboards have the Z of English ones
      {'R', Kind::Joint, NeedleDriver, 1},
      {'F', Kind::Joint, NeedleDriver, -1},
      {keys::kSpace, Kind::Button, ApcPedal, 0},
      {'G', Kind::Button, HelixGrab, 0},
      {'N', Kind::Button, Needle, 0},
      {'T', Kind::Button, TTag, 0},
      {'C', Kind::Button, Cinch, 0},
      {'I', Kind::Button, Insufflate, 0},
      {'1', Kind::Gear, static_cast<int>(DriveGear::Slow), 0},
      {'2', Kind::Gear, static_cast<int>(DriveGear::Normal), 0},
      {'3', Kind::Gear, static_cast<int>(DriveGear::Fast), 0},
      {keys::kShift, Kind::SlowDown, 0, 0},
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
      {{{'W', "W"}, {'S', "S"}}, "in, out (wheel)"},
      {{{'A', "A"}, {'D', "D"}}, "rotate left, right"},
      {{{keys::kUp, "↑"}, {keys::kDown, "↓"}, {keys::kLeft, "←"}, {keys::kRight, "→"}}, "bend tip (drag)", true},
      {{{keys::kSpace, "Space"}}, "argon beam (hold)"},
      {{{'I', "I"}}, "gas on, off", true},
      {{{'E', "E"}, {'Q', "Q"}}, "helix out, in"},
      {{{'G', "G"}}, "helix grab, release"},
      {{{'X', "X"}, {'Z', "Z"}}, "turn helix in, back", true},
      {{{'R', "R"}, {'F', "F"}}, "close, open arm"},
      {{{'N', "N"}}, "pass the needle"},
      {{{'T', "T"}}, "drop the T-tag"},
      {{{'C', "C"}}, "cinch (hold)", true},
      {{{keys::kShift, "Shift"}}, "slow (hold)"},
      {{{'1', "1"}, {'2', "2"}, {'3', "3"}}, "slow, normal, fast", true},
      {{{'V', "V"}}, "next view"},
      {{{'H', "H"}, {keys::kEscape, "Esc"}}, "hide help, leave"},
  };
  return rows;
}

namespace {

constexpr double kInflated = 400;               // gauge pressure, below the set point of the default scene [Pa]
constexpr double kInside = 0.06;                // insertion at which the scripted trainees begin [m]
constexpr double kScrewedIn = 15;               // of the 18.8 rad of the default scene [rad]
constexpr double kDrawnIn = 0.008;              // advance of the helix with the tissue in front of the needle [m]
constexpr double kClosed = 0.95, kOpen = 0.10;  // shares of the way of the arm, as in the simulator
constexpr unsigned kBites = 6;                  // least number of bites of a published set

/// The helix holds tissue, the needle is on the arm.
FirstStep biting(const DriveSituation& now) {
  if (now.joints[NeedleDriver] >= kClosed * now.closed) return {8, "Press N: the needle passes through. A bite!"};
  if (now.joints[HelixAdvance] > kDrawnIn) {
    if (now.joints[HelixRotation] < kScrewedIn) return {5, "Hold X to turn the helix in, for a firm grip"};
    return {6, "Hold Q to draw the tissue in"};
  }
  return {7, "Hold R to close the needle arm"};
}

/// The exchange holds the needle.
FirstStep afterBite(const DriveSituation& now) {
  const bool closed = now.joints[NeedleDriver] >= kClosed * now.closed;
  if (now.holds) {
    if (now.joints[NeedleDriver] > kOpen * now.closed) return {9, "Hold F to open the arm"};
    return {9, "Hold E to let the helix out, then press G to release"};
  }
  if (now.set_bites >= kBites) return {11, "Press T to drop the T-tag, the anchor of the thread"};
  if (closed) return {10, "Press N to take the needle back, then open the arm with F"};
  return {10, "Hold R to close the empty arm over the needle"};
}

FirstStep approaching(const DriveSituation& now) {
  if (now.joints[NeedleDriver] > kOpen * now.closed) return {10, "Hold F to open the arm"};
  if (now.joints[HelixAdvance] < 0.8 * 0.026) return {4, "Hold E to move the helix out"};
  if (!now.touches) return {4, "Move the helix against the wall with W and the arrows"};
  return {4, "Press G: the helix grabs the wall"};
}

}  // namespace

FirstStep firstStep(const DriveSituation& now) {
  if (now.sets_tagged > 0) return {12, "Hold C to draw the thread tight, then let go"};
  if (now.sets_done > 0) return {12, "A set is complete. Make the next one further up"};
  if (now.set_bites == 0 && !now.holds) {
    if (!now.gas_on && now.pressure < kInflated) return {1, "Press I: gas opens the stomach"};
    if (now.joints[Insertion] < kInside) return {2, "Hold W to insert the endoscope"};
    if (now.marks == 0) return {3, "Bend towards the wall with the arrows, then hold Space to mark it"};
  }
  if (!now.needle_loaded) return {12, "A new needle comes with the next set"};
  if (!now.needle_on_arm) return afterBite(now);
  return now.holds ? biting(now) : approaching(now);
}

}  // namespace vibe::operating
