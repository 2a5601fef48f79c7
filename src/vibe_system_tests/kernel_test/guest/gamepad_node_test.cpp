// gamepad_node with a virtual pad of the kernel: commands from its sticks, and what its motors are asked for.

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <vibe_msgs/HapticParameters.h>

#include <algorithm>
#include <cmath>

#include "ros_graph.hpp"
#include "statistics.hpp"
#include "virtual_pad.hpp"

namespace vibe::hardware {
namespace {

constexpr const char* kName = "virtual test pad";
constexpr double kPeriod = 0.02;     // of what the simulator would send [s]
constexpr double kTolerance = 0.01;  // of a motor's range

class GamepadNode : public testing::Test {
 protected:
  GamepadNode() : pad_(kName) {
    ros::NodeHandle& handle = graph_.handle();
    joints_ = handle.advertise<sensor_msgs::JointState>("joint_states", 10);
    force_ = handle.advertise<geometry_msgs::WrenchStamped>("scope/measured_cf", 10);
    parameters_ = handle.advertise<vibe_msgs::HapticParameters>("haptic/parameters", 10);
    commands_ = handle.subscribe<sensor_msgs::JointState>(
        "scope/servo_jp", 100, [this](const sensor_msgs::JointStateConstPtr& message) { command_ = *message; });
    buttons_ = handle.subscribe<sensor_msgs::Joy>(
        "scope/buttons", 100, [this](const sensor_msgs::JoyConstPtr& message) { pressed_ = message->buttons; });
  }

  void start(const std::string& mapping) {
    const std::string address = "package://vibe_hardware/config/gamepads/" + mapping;
    node_ = RosGraph::start("gamepad_node", {std::string("_pad:=") + kName, "_mapping:=" + address});
    ASSERT_TRUE(playUntil([this] { return !node_->running() || !command_.position.empty(); })) << "no command";
    ASSERT_TRUE(node_->running()) << "gamepad_node has ended with " << node_->ending()
                                  << "; see its message above, if any";
  }

  /// Plays the simulator until the condition holds.
  bool playUntil(const std::function<bool()>& condition) {
    double next = 0;
    return RosGraph::waitUntil([&] {
      if (now() >= next) {
        joints_.publish(jointsAtRest());
        if (pushes_) push();
        next = now() + kPeriod;
      }
      return condition();
    });
  }

  static sensor_msgs::JointState jointsAtRest() {
    sensor_msgs::JointState message;
    message.header.stamp = ros::Time::now();
    message.name = {"insertion",     "rotation",       "tip_up_down",  "tip_left_right",
                    "helix_advance", "helix_rotation", "needle_driver"};
    message.position.assign(message.name.size(), 0);
    return message;
  }

  /// The tissue pushes the tool, and the tip to 0.5 rad on the left.
  void push() {
    geometry_msgs::WrenchStamped wrench;
    wrench.wrench.force.z = 2.5;
    force_.publish(wrench);
    vibe_msgs::HapticParameters message;
    message.touching = true;
    message.joint_name = {"insertion", "rotation", "tip_up_down", "tip_left_right"};
    message.joint_stiffness[3] = 0.05;
    message.joint_equilibrium[3] = 0.5;
    parameters_.publish(message);
  }

  double command(const std::string& joint) const {
    const auto found = std::find(command_.name.begin(), command_.name.end(), joint);
    return command_.position.at(static_cast<std::size_t>(found - command_.name.begin()));
  }

  bool rumbles(double strong) const {
    ff_effect effect{};
    return pad_.playing(FF_RUMBLE, effect) && near(effect.u.rumble.strong_magnitude, strong * 0xFFFF, 0xFFFF);
  }

  bool pulls(double centre, double coefficient) const {
    ff_effect effect{};
    if (!pad_.playing(FF_SPRING, effect)) return false;
    const ff_condition_effect& x = effect.u.condition[0];
    return near(x.center, centre * 0x7FFF, 0x7FFF) && near(x.right_coeff, coefficient * 0x7FFF, 0x7FFF);
  }

  static bool near(double value, double expected, double range) {
    return std::abs(value - expected) < kTolerance * range;
  }

  RosGraph graph_;
  VirtualPad pad_;
  std::unique_ptr<ChildProcess> node_;
  ros::Publisher joints_, force_, parameters_;
  ros::Subscriber commands_, buttons_;
  sensor_msgs::JointState command_;
  std::vector<std::int32_t> pressed_;
  bool pushes_ = false;
};

TEST_F(GamepadNode, SticksAndButtonsBecomeCommands) {
  ASSERT_NO_FATAL_FAILURE(start("two_stick.yaml"));
  EXPECT_EQ(command("rotation"), 0);
  pad_.send(EV_ABS, ABS_X, VirtualPad::kAxisLimit);
  EXPECT_TRUE(playUntil([this] { return command("rotation") > 0.05; }));
  EXPECT_EQ(command("insertion"), 0);
  pad_.send(EV_KEY, BTN_SOUTH, 1);
  pad_.send(EV_KEY, BTN_SOUTH, 0);
  EXPECT_TRUE(playUntil([this] { return std::count(pressed_.begin(), pressed_.end(), 1) == 1; }));
  EXPECT_EQ(pressed_.at(1), 1) << "helix_grab";
}

TEST_F(GamepadNode, AForceShakesThePadAndTheTissuePullsTheStick) {
  ASSERT_NO_FATAL_FAILURE(start("flight_stick.yaml"));
  pushes_ = true;
  EXPECT_TRUE(playUntil([this] { return rumbles(2.5 / 5); }));  // rumble_force: 5 N
  // tip_left_right: 100 deg either way, reversed; full_effort: 0.3 N m
  const double half = 100 * M_PI / 180;
  EXPECT_TRUE(playUntil([&] { return pulls(-0.5 / half, 0.05 * half / 0.3); }));
  pushes_ = false;
  EXPECT_TRUE(playUntil([this] { return rumbles(0) && pulls(0, 0); }));
}

}  // namespace
}  // namespace vibe::hardware
