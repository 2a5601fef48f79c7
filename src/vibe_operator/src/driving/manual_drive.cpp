#include "vibe_operator/driving/manual_drive.hpp"

#include <utility>
#include <vector>

#include "driving/scope_sender.hpp"
#include "vibe_operator/driving/button_sender.hpp"
#include "vibe_operator/messages/command_messages.hpp"

namespace vibe::operating {

class ManualDrive::Parts {
 public:
  explicit Parts(const std::string& name)
      : sender_([this](int button, bool down) { changes_.emplace_back(button, down); }), buttons_(name) {}

  void start(const std::string& name_space) {
    sender_.releaseAll();
    passButtons();
    active_ = true;
    name_space_trouble_ = checkNamespace(name_space);
    if (!name_space_trouble_.empty()) return sender_.stop();
    buttons_.listen(name_space);
    sender_.start(name_space);
  }

  void stop() {
    sender_.releaseAll();
    passButtons();
    active_ = false;
    sender_.stop();
    buttons_.setControl(false, steadySeconds());
  }

  /// Presses and releases that keys have caused, in the thread that owns the buttons.
  void passButtons() {
    if (changes_.empty()) return;
    const Moment now = moment(sender_.view());
    for (const auto& [button, down] : std::exchange(changes_, {}))
      if (down)
        buttons_.press(button, now);
      else
        buttons_.release(button, now);
  }

  void tick() {
    const ScopeSender::View view = sender_.view();
    const Moment now = moment(view);
    const bool control = active_ && view.driving;
    if (control != buttons_.inControl()) buttons_.setControl(control, now.wall);
    if (!now.paused || !buttons_.inControl()) buttons_.tick(now);  // during a pause only presses are published
  }

  DriveView view() const {
    const ScopeSender::View seen = sender_.view();
    DriveView view;
    view.driving = seen.driving;
    view.trouble = name_space_trouble_.empty() ? seen.trouble : name_space_trouble_;
    view.keys_down = seen.keys_down;
    view.gear = seen.gear;
    view.joints = seen.joints;
    view.limits = seen.limits;
    view.force = seen.force;
    view.state = seen.state;
    for (std::size_t i = 0; i < view.buttons.size(); ++i) view.buttons[i] = buttons_.down()[i] != 0;
    if (!view.state) return view;
    if (view.trouble.empty() && view.state->paused) view.trouble = "The simulator is paused. Resume it to drive.";
    if (view.trouble.empty() && view.driving && !buttons_.inControl() && !buttons_.isTakingControl())
      view.trouble = "No buttons: " + buttons_.sentence(steadySeconds());
    view.step = stepOf(view);
    return view;
  }

  ScopeSender sender_;
  ButtonSender buttons_;
  bool active_ = false;

 private:
  static FirstStep stepOf(const DriveView& view) {
    DriveSituation situation = situationOf(*view.state);
    situation.touches = situation.touches || view.force > 0;  // the state tells of gas first
    situation.joints = view.joints;
    situation.closed = view.limits[NeedleDriver].upper;
    situation.gas_on = view.buttons[5];
    return firstStep(situation);
  }

  static Moment moment(const ScopeSender::View& view) {
    Moment now;
    now.wall = steadySeconds();
    now.stamp = ros::Time::now().toSec();
    if (!view.state) return now;
    now.step_period = view.state->step_period;
    now.step = view.state->step;
    now.paused = view.state->paused;
    return now;
  }

  std::vector<std::pair<int, bool>> changes_;  // of keys, not passed on yet
  std::string name_space_trouble_;
};

ManualDrive::ManualDrive(const std::string& name) : parts_(std::make_unique<Parts>(name)) {}
ManualDrive::~ManualDrive() = default;

void ManualDrive::start(const std::string& name_space) {
  parts_->start(name_space);
}

void ManualDrive::stop() {
  parts_->stop();
}

bool ManualDrive::isSilent() const {
  return !parts_->active_ && !parts_->buttons_.closing();
}

void ManualDrive::setSpeeds(const DriveSpeeds& speeds) {
  parts_->sender_.setSpeeds(speeds);
}

void ManualDrive::keyDown(int key) {
  parts_->sender_.keyDown(key);
  parts_->passButtons();
}

void ManualDrive::keyUp(int key) {
  parts_->sender_.keyUp(key);
  parts_->passButtons();
}

void ManualDrive::releaseAll() {
  parts_->sender_.releaseAll();
  parts_->passButtons();
}

void ManualDrive::displace(int joint, double by) {
  parts_->sender_.displace(joint, by);
}

void ManualDrive::tick() {
  parts_->tick();
}

DriveView ManualDrive::view() const {
  return parts_->view();
}

}  // namespace vibe::operating
