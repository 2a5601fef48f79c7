#pragma once
#include <utility>

#include "vibe_core/trainee/trainee_script.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware {

/// Plays a trainee script: the motions of all joints, with their tremor, and the buttons, as vibe_trainee does.
class ScriptedHand : public Hand {
 public:
  explicit ScriptedHand(TraineeScript script) : script_(std::move(script)) {}

  HandSample at(double time) const override;
  double duration() const override { return script_.duration(); }

 private:
  TraineeScript script_;
};

}  // namespace vibe::hardware
