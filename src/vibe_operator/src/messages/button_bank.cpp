#include "vibe_operator/messages/button_bank.hpp"

namespace vibe::operating {
namespace {

constexpr double kMinPress = 0.1;    // design choice: several steps at 60 Hz [s]
constexpr double kStepsPressed = 2;  // one may be in progress when the message arrives

bool isCommand(int button) {
  return button >= 0 && button < kCommandCount;
}

bool wasSeen(const Moment& pressed, const Moment& now) {
  if (now.paused) return now.step != pressed.step;
  const bool set_back = now.stamp < pressed.stamp;
  return now.wall - pressed.wall >= kMinPress &&
         (set_back || now.stamp - pressed.stamp >= kStepsPressed * now.step_period);
}

}  // namespace

const std::array<Command, kCommandCount>& commands() {
  static const std::array<Command, kCommandCount> all = {{
      {"APC pedal", "Heats the wall while held, with the probe 0 to 5 mm away: first marks, then burns.", false},
      {"Helix grab", "Press to grab the tissue at the helix; press again to release it.", true},
      {"Needle",
       "Passes the needle to the exchange after the arm has closed (a bite), or takes it back for the next one.",
       false},
      {"T-tag",
       "Drops the needle as the anchor of the thread after the last bite of a set; the set then takes no more bites.",
       false},
      {"Cinch", "Hold to draw the thread in; releasing crimps the cinch and cuts the thread, and the set is permanent.",
       false},
      {"Insufflate", "Press to insufflate up to the set point; press again to stop.", true},
  }};
  return all;
}

void ButtonBank::press(int button, const Moment& now) {
  if (!isCommand(button)) return;
  const auto i = static_cast<std::size_t>(button);
  if (commands()[i].toggles) {
    down_[i] = 1 - down_[i];
    return;
  }
  down_[i] = 1;
  let_go_[i] = false;
  pressed_[i] = now;
}

void ButtonBank::release(int button) {
  if (!isCommand(button)) return;
  const auto i = static_cast<std::size_t>(button);
  if (!commands()[i].toggles) let_go_[i] = true;
}

bool ButtonBank::settle(const Moment& now) {
  bool changed = false;
  for (std::size_t i = 0; i < down_.size(); ++i) {
    if (commands()[i].toggles || down_[i] == 0) continue;
    // a button pressed in a pause counts from the end of the pause
    if (now.paused && now.step == pressed_[i].step) pressed_[i] = now;
    if (!let_go_[i] || !wasSeen(pressed_[i], now)) continue;
    down_[i] = 0;
    changed = true;
  }
  return changed;
}

void ButtonBank::adopt(const std::vector<std::int32_t>& buttons) {
  if (buttons.size() != down_.size()) return;
  for (std::size_t i = 0; i < down_.size(); ++i)
    if (commands()[i].toggles) down_[i] = buttons[i] != 0 ? 1 : 0;
}

void ButtonBank::liftHeld() {
  for (std::size_t i = 0; i < down_.size(); ++i)
    if (!commands()[i].toggles) down_[i] = 0;
}

}  // namespace vibe::operating
