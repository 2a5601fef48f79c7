#pragma once
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Writes a trainee script while playing it, so that each action can depend on the state of the tissue after the
/// previous one. The resulting script is open-loop: on the same scene and seed it reproduces the run bit for bit.
class ScriptRecorder {
 public:
  /// @param header  of the script: name, seed, tremor; YAML lines without "actions:"
  ScriptRecorder(const std::shared_ptr<const Model>& model, std::string header);

  /// Appends an action in the format of docs/trainee_scripts.md, without the dash, and plays it.
  /// @throws Error if the script format does not allow it
  void act(const std::string& action);
  void phase(const std::string& name) { act("phase: " + name); }
  void wait(double seconds);
  /// Moves joints to positions at hand speed, in at least `min` seconds.
  /// @param joints  entries that are not finite keep their position
  void moveTo(const std::array<double, kJointCount>& joints, double min);
  void move(Joint joint, double position, double min);
  void hold(Button button, double seconds);

  /// Called with every event; may be empty.
  std::function<void(const Event&)> on_event;
  /// Speed of the hand relative to an experienced one [1].
  double pace = 1;

  const Model& model() const { return simulation_.model(); }
  const State& state() const { return simulation_.state(); }
  /// Last commanded joint positions, without tremor [m], [rad].
  const std::array<double, kJointCount>& joints() const { return joints_; }
  /// Events of the last action.
  const std::vector<Event>& events() const { return events_; }
  bool happened(Event::Kind kind) const;
  const std::string& script() const { return script_; }

 private:
  void play();

  Simulation simulation_;
  std::vector<Event> events_;
  std::array<double, kJointCount> joints_{};
  std::string script_;
};

}  // namespace vibe
