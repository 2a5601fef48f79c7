#pragma once
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/workspace.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Writes a trainee script while it is played: what an action did to the tissue is there before the next one is chosen.
/// The script that comes out is open-loop: played on the same scene and seed it does the same again, to the bit.
class ScriptRecorder {
 public:
  /// @param header  of the script: name, seed, tremor; YAML lines without "actions:"
  ScriptRecorder(std::shared_ptr<const Model> model, std::string header);

  /// Appends an action as docs/trainee_scripts.md has it, without the dash, and plays it.
  /// @throws Error if the script does not allow it
  void act(const std::string& action);
  void phase(const std::string& name) { act("phase: " + name); }
  void wait(double seconds);
  /// Moves joints to positions, with a hand's speed and in no less than `least` seconds.
  /// @param joints  entries that are not finite stay
  void moveTo(const std::array<double, kJointCount>& joints, double min);
  void move(Joint joint, double position, double min);
  void hold(Button button, double seconds);

  /// Told of everything that happens; may be empty.
  std::function<void(const Event&)> on_event;
  /// How fast the hand is, against an experienced one [1].
  double pace = 1;

  const Model& model() const { return *model_; }
  const State& state() const { return state_; }
  /// Where the last command sent the joints, without tremor [m], [rad].
  const std::array<double, kJointCount>& joints() const { return joints_; }
  /// Of the last action.
  const std::vector<Event>& events() const { return events_; }
  bool happened(Event::Kind kind) const;
  const std::string& script() const { return script_; }

 private:
  void play();

  std::shared_ptr<const Model> model_;
  State state_;
  Workspace workspace_;
  std::vector<Event> events_;
  std::array<double, kJointCount> joints_{};
  std::string script_;
};

}  // namespace vibe
