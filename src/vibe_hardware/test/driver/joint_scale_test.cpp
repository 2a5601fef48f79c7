#include "vibe_hardware/driver/joint_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vibe::hardware::joint_scale_test {
namespace {

double force(const JointSpring& s, double x, double v) {
  return s.effort - s.stiffness * (x - s.position) - s.damping * (v - s.velocity);
}

class JointScaleTest : public testing::Test {
 protected:
  std::mt19937 random{1};

  double any(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  JointScale anyScale() { return {any(0.001, 0.1) * (any(-1, 1) > 0 ? 1 : -1), any(-0.3, 0.3)}; }
  JointSpring anySpring() { return {any(-0.3, 0.3), any(-5, 5), any(0, 500), any(0, 20), any(-0.1, 0.1)}; }
};

TEST_F(JointScaleTest, PositionsGoThereAndBack) {
  for (int i = 0; i < 1000; ++i) {
    const JointScale scale = anyScale();
    const double x = any(-0.3, 0.3);
    EXPECT_NEAR(jointPosition(scale, axisPosition(scale, x)), x, 1e-12);
  }
}

TEST_F(JointScaleTest, PowerIsTheSameOnBothSides) {
  for (int i = 0; i < 1000; ++i) {
    const JointScale scale = anyScale();
    const JointSpring joint = anySpring();
    const JointSpring axis = springOnAxis(scale, joint);
    const double angle = any(-30, 30), speed = any(-10, 10);
    const double torque = force(axis, angle, speed);
    const double effort = force(joint, jointPosition(scale, angle), scale.scale * speed);
    EXPECT_NEAR(torque * speed, effort * scale.scale * speed, 1e-9 * (1 + std::abs(torque * speed)));
    EXPECT_NEAR(jointEffort(scale, torque), effort, 1e-9 * (1 + std::abs(effort)));
  }
}

TEST_F(JointScaleTest, TheDevicesLawIsTheSameSpringWithDampingAboutRest) {
  for (int i = 0; i < 1000; ++i) {
    const JointScale scale = anyScale();
    const JointSpring joint = anySpring();
    const vibe_firmware::AxisParameters p = axisSpring(scale, joint, 1);
    const double angle = any(-30, 30), speed = any(-10, 10);
    const double torque = p.torque - p.stiffness * (angle - p.position) - p.damping * speed;
    const double wanted = force(springOnAxis(scale, joint), angle, speed);
    EXPECT_NEAR(torque, wanted, 1e-5 * (1 + std::abs(wanted) + p.stiffness * 60));
    EXPECT_GE(p.stiffness, 0);
    EXPECT_GE(p.damping, 0);
  }
}

}  // namespace
}  // namespace vibe::hardware::joint_scale_test
