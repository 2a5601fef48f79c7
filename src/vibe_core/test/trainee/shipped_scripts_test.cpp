// What the shipped scripts ask for, against what the tool can do.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "vibe_core/tool/tool_model.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe::shipped_scripts_test {
namespace {

const std::array<JointLimits, kJointCount>& toolLimits() {
  static const ToolModel tool = [] {
    const std::string file = std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf";
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return ToolModel::fromUrdf(text.str(), file);
  }();
  return tool.limits();
}

class ShippedScript : public ::testing::TestWithParam<const char*> {
 protected:
  TraineeScript script_ = TraineeScript::load(std::string(VIBE_CORE_DIR) + "/trainees/" + GetParam());
};

/// Tremor may carry a joint this far beyond an end of its range, where the simulator stops it [m], [rad].
constexpr double kTremorRoom = 0.03;

TEST_P(ShippedScript, StaysWithinTheJointLimits) {
  for (double t = 0; t <= script_.duration(); t += 0.01) {
    const StepInput input = script_.at(t);
    for (int joint = 0; joint < kJointCount; ++joint) {
      const JointLimits& limit = toolLimits()[joint];
      const double room = kTremorRoom * (limit.upper - limit.lower);
      EXPECT_GE(input.joints[joint], limit.lower - room) << kJointNames[joint] << " at " << t;
      EXPECT_LE(input.joints[joint], limit.upper + room) << kJointNames[joint] << " at " << t;
    }
  }
}

/// Over a period long enough to average tremor out: otherwise the tool would lag behind the script.
TEST_P(ShippedScript, StaysWithinTheJointSpeeds) {
  constexpr double kPeriod = 0.2;
  for (double t = 0; t + kPeriod <= script_.duration(); t += 0.02) {
    const StepInput a = script_.at(t), b = script_.at(t + kPeriod);
    for (int joint = 0; joint < kJointCount; ++joint) {
      const double speed = std::abs(b.joints[joint] - a.joints[joint]) / kPeriod;
      EXPECT_LE(speed, toolLimits()[joint].velocity) << kJointNames[joint] << " at " << t;
    }
  }
}

TEST_P(ShippedScript, EndsWithdrawnWithNothingPressed) {
  const StepInput end = script_.at(script_.duration());
  EXPECT_LT(end.joints[Insertion], 0.03);
  for (int button = 0; button < kButtonCount; ++button) EXPECT_EQ(end.buttons[button], 0) << kButtonNames[button];
  EXPECT_EQ(script_.phaseAt(script_.duration()), "withdraw");
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScript,
                         ::testing::Values("demo/grabs.yaml", "demo/clumsy_grabs.yaml", "demo/smoke.yaml",
                                           "demo/five_states.yaml"));

}  // namespace
}  // namespace vibe::shipped_scripts_test
