#include "vibe_core/input/step_input.hpp"

namespace vibe {

const std::array<const char*, kJointCount> kJointNames = {
    "insertion", "rotation", "tip_up_down", "tip_left_right", "helix_advance", "helix_rotation", "needle_driver"};

const std::array<const char*, kButtonCount> kButtonNames = {"apc_pedal", "helix_grab", "needle",
                                                            "t_tag",     "cinch",      "insufflate"};

}  // namespace vibe
