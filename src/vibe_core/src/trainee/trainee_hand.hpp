#pragma once
#include <array>
#include <functional>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/trainee/observation.hpp"
#include "vibe_core/trainee/skill.hpp"

namespace vibe {

/// The hands of a trainee: elementary motions, each of which lasts some steps and perceives what happens meanwhile.
/// Calls return when the motion has ended.
class TraineeHand {
 public:
  using Joints = std::array<double, kJointCount>;

  /// @param next  ends the present step and returns when the next one has been perceived
  TraineeHand(const Model& model, const Skill& skill, std::function<void()> next);

  /// Called before the coroutine goes on.
  void perceive(const Observation& seen);

  const Model& model() const { return model_; }
  const Skill& skill() const { return skill_; }
  const Observation& view() const { return *view_; }
  const StepInput& command() const { return command_; }
  const Joints& joints() const { return command_.joints; }  ///< commanded

  void wait(double seconds);
  /// @return whether the condition became true in time
  bool await(const std::function<bool()>& condition, double patience);

  /// Moves joints to positions at hand speed, in at least `min` seconds at an experienced pace. Entries that are not
  /// finite stay.
  /// @param stop  ends the motion on its way where it becomes true; empty: never
  /// @return false if it was stopped
  bool moveTo(const Joints& joints, double min, const std::function<bool()>& stop = {});
  bool move(Joint joint, double position, double min, const std::function<bool()>& stop = {});
  /// What is felt is more than the skill allows. For `stop`.
  bool feelsTooMuch() const { return view_->force.norm() > skill_.force_limit; }

  void press(Button button) { command_.buttons[button] = 1; }
  void release(Button button) { command_.buttons[button] = 0; }
  void hold(Button button, double seconds);

  /// Events since the last forget().
  bool happened(Event::Kind kind) const { return find(kind) != nullptr; }
  const Event* find(Event::Kind kind) const;
  void forget() { events_.clear(); }

 private:
  const Model& model_;
  const Skill& skill_;
  std::function<void()> next_;
  const Observation* view_ = nullptr;
  StepInput command_;
  std::vector<Event> events_;
};

}  // namespace vibe
