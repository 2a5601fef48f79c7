#pragma once
#include <utility>

#include "vibe_core/trainee/trainee_script.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe {

/// Plays a trainee script: the motions of the four joints of the endoscope, with their tremor, and the buttons. The
/// joints of the suturing device are not on these devices and are left out.
class ScriptedHand : public Hand {
 public:
  explicit ScriptedHand(TraineeScript script) : script_(std::move(script)) {}

  HandSample at(double time) const override;
  double duration() const override { return script_.duration(); }

 private:
  TraineeScript script_;
};

}  // namespace vibe
