#include "vibe_hardware/emulator/scripted_hand.hpp"

#include <algorithm>

namespace vibe {

HandSample ScriptedHand::at(double time) const {
  const StepInput input = script_.at(time);
  HandSample sample;
  std::copy_n(input.joints.begin(), sample.joints.size(), sample.joints.begin());
  sample.buttons = input.buttons;
  return sample;
}

}  // namespace vibe
