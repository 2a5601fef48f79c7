#include "vibe_core/trainee/script_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe {

namespace {

constexpr double kPeakOverMean = 1.875;  // of the speed of a minimum-jerk movement (Flash & Hogan 1985)

// mean speeds of an experienced operator, design choice [m/s], [rad/s]
constexpr std::array<double, kJointCount> kHandSpeed{0.04, 1.2, 1.2, 1.2, 0.025, 12.5, 0.05};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

ScriptRecorder::ScriptRecorder(const std::shared_ptr<const Model>& model, std::string header)
    : simulation_(model, SimulationSettings::study(model->scene.seed)), script_(std::move(header) + "actions:\n") {}

void ScriptRecorder::act(const std::string& action) {
  script_ += "  - " + action + "\n";
  events_.clear();
  play();
  if (on_event)
    for (const Event& event : events_) on_event(event);
}

void ScriptRecorder::play() {
  const TraineeScript script = TraineeScript::parse(script_, "the recorded script");
  // the same number of steps as in the programs that play scripts
  const std::int64_t end = std::lround(script.duration() / simulation_.stepPeriod());
  simulation_.run(
      end - simulation_.stepCount(), [&](double time) { return script.at(time); },
      [this](const Simulation& s) { events_.insert(events_.end(), s.events().begin(), s.events().end()); });
}

void ScriptRecorder::wait(double seconds) {
  act("{wait: " + number(seconds) + "}");
}

void ScriptRecorder::moveTo(const std::array<double, kJointCount>& joints, double min) {
  double time = min;
  std::string text;
  for (int j = 0; j < kJointCount; ++j) {
    if (!std::isfinite(joints[j]) || std::abs(joints[j] - joints_[j]) < 1e-6) continue;
    const double way = std::abs(joints[j] - joints_[j]);
    time = std::max({time, way / (pace * kHandSpeed[j]), kPeakOverMean * way / model().tool->limits()[j].velocity});
    text += (text.empty() ? "" : ", ") + std::string(kJointNames[j]) + ": " + number(joints[j]);
    joints_[j] = joints[j];
  }
  if (!text.empty()) act("{move: {" + text + "}, in: " + number(std::ceil(time * 20) / 20) + "}");
}

void ScriptRecorder::move(Joint joint, double position, double min) {
  std::array<double, kJointCount> joints;
  joints.fill(std::numeric_limits<double>::quiet_NaN());
  joints[joint] = position;
  moveTo(joints, min);
}

void ScriptRecorder::hold(Button button, double seconds) {
  act("{hold: " + std::string(kButtonNames[button]) + ", for: " + number(seconds) + "}");
}

bool ScriptRecorder::happened(Event::Kind kind) const {
  return std::any_of(events_.begin(), events_.end(), [kind](const Event& event) { return event.kind == kind; });
}

}  // namespace vibe
