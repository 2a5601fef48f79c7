#include "vibe_operator/driving/manual_drive.hpp"

#include <utility>
#include <vector>

#include "vibe_operator/messages/command_messages.hpp"

namespace vibe::operating {

namespace {

FirstStep stepOf(const DriveView& view) {
  DriveSituation situation = situationOf(*view.state);
  situation.touches = situation.touches || view.force > 0;  // the state tells of gas first
  situation.joints = view.joints;
  situation.closed = view.limits[NeedleDriver].upper;
  situation.gas_on = view.buttons[5];
  return firstStep(situation);
}

Moment momentOf(const DriveView& view) {
  Moment now;
  now.wall = steadySeconds();
  now.stamp = ros::Time::now().toSec();
  if (!view.state) return now;
  now.step_period = view.state->step_period;
  now.step = view.state->step;
  now.paused = view.state->paused;
  return now;
}

}  // namespace

ManualDrive::ManualDrive(const std::string& name)
    : sender_([this](int button, bool down) { changes_.emplace_back(button, down); }), buttons_(name) {}

void ManualDrive::start(const std::string& name_space) {
  releaseAll();
  active_ = true;
  name_space_trouble_ = checkNamespace(name_space);
  if (!name_space_trouble_.empty()) return sender_.stop();
  buttons_.listen(name_space);
  sender_.start(name_space);
}

void ManualDrive::stop() {
  releaseAll();
  active_ = false;
  sender_.stop();
  buttons_.setControl(false, steadySeconds());
}

void ManualDrive::keyDown(int key) {
  sender_.keyDown(key);
  passButtons();
}

void ManualDrive::keyUp(int key) {
  sender_.keyUp(key);
  passButtons();
}

void ManualDrive::releaseAll() {
  sender_.releaseAll();
  passButtons();
}

/// Presses and releases that keys have caused, in the thread that owns the buttons.
void ManualDrive::passButtons() {
  if (changes_.empty()) return;
  const Moment now = momentOf(sender_.view());
  for (const auto& [button, down] : std::exchange(changes_, {}))
    if (down)
      buttons_.press(button, now);
    else
      buttons_.release(button, now);
}

void ManualDrive::tick() {
  const DriveView view = sender_.view();
  const Moment now = momentOf(view);
  const bool control = active_ && view.driving;
  if (control != buttons_.inControl()) buttons_.setControl(control, now.wall);
  if (!now.paused || !buttons_.inControl()) buttons_.tick(now);  // during a pause only presses are published
}

DriveView ManualDrive::view() const {
  DriveView view = sender_.view();
  if (!name_space_trouble_.empty()) view.trouble = name_space_trouble_;
  for (std::size_t i = 0; i < view.buttons.size(); ++i) view.buttons[i] = buttons_.down()[i] != 0;
  if (!view.state) return view;
  if (view.trouble.empty() && view.state->paused) view.trouble = "The simulator is paused. Resume it to drive.";
  if (view.trouble.empty() && view.driving && !buttons_.inControl() && !buttons_.isTakingControl())
    view.trouble = "No buttons: " + buttons_.sentence(steadySeconds());
  view.step = stepOf(view);
  return view;
}

}  // namespace vibe::operating
