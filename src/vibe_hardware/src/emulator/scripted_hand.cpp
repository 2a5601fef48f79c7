#include "vibe_hardware/emulator/scripted_hand.hpp"

namespace vibe::hardware {

HandSample ScriptedHand::at(double time) const {
  const StepInput input = script_.at(time);
  return {input.joints, input.buttons};
}

}  // namespace vibe::hardware
