#include "vibe_core/trainee/trainee_script.hpp"

#include <algorithm>
#include <limits>

#include "trainee/operator.hpp"

namespace vibe {

void Timeline::addMotion(int joint, double begin, double end, double to) {
  motions_[joint].push_back({begin, end, jointTarget(joint), to});
  extendTo(end);
}

void Timeline::addEdge(int button, double time, bool pressed) {
  edges_[button].push_back({time, pressed});
  extendTo(time);
}

void Timeline::addPhase(double time, const std::string& name) {
  phases_.push_back({time, name});
  extendTo(time);
}

void Timeline::extendTo(double time) {
  duration_ = std::max(duration_, time);
}

double Timeline::jointFreeAt(int joint) const {
  return motions_[joint].empty() ? 0 : motions_[joint].back().end;
}

double Timeline::jointTarget(int joint) const {
  return motions_[joint].empty() ? start_[joint] : motions_[joint].back().to;
}

bool Timeline::isPressed(int button) const {
  return !edges_[button].empty() && edges_[button].back().pressed;
}

double Timeline::lastEdge(int button) const {
  return edges_[button].empty() ? -std::numeric_limits<double>::infinity() : edges_[button].back().time;
}

double Timeline::position(int joint, double time) const {
  const std::vector<Motion>& motions = motions_[joint];
  const auto next = std::upper_bound(motions.begin(), motions.end(), time,
                                     [](double t, const Motion& motion) { return t < motion.begin; });
  if (next == motions.begin()) return start_[joint];
  const Motion& motion = *(next - 1);
  if (time >= motion.end) return motion.to;
  const double share = (time - motion.begin) / (motion.end - motion.begin);
  return motion.from + (motion.to - motion.from) * minimumJerk(share);
}

bool Timeline::pressed(int button, double time) const {
  const std::vector<Edge>& edges = edges_[button];
  const auto next =
      std::upper_bound(edges.begin(), edges.end(), time, [](double t, const Edge& edge) { return t < edge.time; });
  return next != edges.begin() && (next - 1)->pressed;
}

const std::string& Timeline::phase(double time) const {
  static const std::string none;
  const auto next = std::upper_bound(phases_.begin(), phases_.end(), time,
                                     [](double t, const Phase& phase) { return t < phase.time; });
  return next == phases_.begin() ? none : (next - 1)->name;
}

StepInput TraineeScript::at(double time) const {
  const double t = time > 0 ? std::min(time, duration()) : 0;  // also for NaN
  StepInput input;
  for (int joint = 0; joint < kJointCount; ++joint) {
    input.joints[joint] = timeline_.position(joint, t) + tremor_.at(joint, t);
  }
  for (int button = 0; button < kButtonCount; ++button) input.buttons[button] = timeline_.pressed(button, t) ? 1 : 0;
  return input;
}

const std::string& TraineeScript::phaseAt(double time) const {
  return timeline_.phase(time > 0 ? std::min(time, duration()) : 0);
}

}  // namespace vibe
