#include "vibe_operator/messages/session_watch.hpp"

#include <ros/names.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "vibe_operator/messages/number_text.hpp"

namespace vibe::operating {
namespace {

constexpr double kSilentAfter = 2;  // the same as in the simulator [s]
constexpr double kWindow = 1;       // [s]

}  // namespace

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string SimulatorWatch::problem(const std::string& topic, double now) const {
  if (waits()) return "Waiting for the simulator on " + topic + "; start it, or set the namespace below.";
  if (!isGone(now)) return {};
  return "The simulator is gone: no message on " + topic + " for " + quantityText(silence(now), 0, "s") +
         "; the values shown are old.";
}

std::string ControlWatch::rival(double now) const {
  return !publisher_.empty() && now - last_ < kSilentAfter ? publisher_ : std::string();
}

std::string ControlWatch::sentence(const std::string& topic, bool in_control, unsigned others, unsigned listeners,
                                   double now) const {
  const std::string other = rival(now);
  if (in_control) {
    if (!other.empty()) return "You have control of " + topic + "; " + other + " publishes it too and is ignored.";
    if (listeners == 0) return "You press the buttons, but no simulator listens to " + topic + ".";
    return "You have control of " + topic + ".";
  }
  if (!other.empty())
    return other + " has control of " + topic + "; stop it to take control, because only one publisher is obeyed.";
  if (others > 0)
    return "Nobody presses buttons, but " + countText(others, "silent publisher") + " of " + topic +
           " may take control again; switch on 'Take control' first.";
  return "Nobody has control of " + topic + "; switch on 'Take control' to press buttons.";
}

void MaxOfWindow::add(double value, double now) {
  if (now - begin_ < kWindow) {
    max_ = std::max(max_, value);
    return;
  }
  has_last_ = now - begin_ < 2 * kWindow;
  last_ = max_;
  max_ = value;
  begin_ = now;
}

double MaxOfWindow::value(double now) const {
  return has_last_ && now - begin_ < 2 * kWindow ? last_ : std::numeric_limits<double>::quiet_NaN();
}

std::string checkNamespace(const std::string& name) {
  std::string error;
  if (name.empty() || ros::names::validate(name, error)) return {};
  return "The namespace '" + name + "' cannot be used: letters, digits, _ and / are allowed, with a letter first.";
}

}  // namespace vibe::operating
