// hardware_node with the kernel's hidraw: every report becomes a message, parameters arrive in the device, replugging.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/OperatingState.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <thread>

#include "plugged_device.hpp"
#include "ros_graph.hpp"
#include "statistics.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {
namespace {

using namespace vibe_firmware;

constexpr const char* kConfig = "/run/vibe_guest/devices.yaml";
constexpr double kRoller = 0.01;               // radius: insertion per angle [m/rad]
constexpr double kAxisStiffness = 0.01;        // asked of both axes [N m/rad]
constexpr double kAxisDamping = 2e-4;          // [N m s/rad]
constexpr double kPosition = 1;                // of the springs [rad]
constexpr std::size_t kDiagnosticPeriods = 3;  // after which the counts of a moment ago are in the diagnostics

void writeConfig() {
  std::ofstream(kConfig) << R"(
devices:
  haptic: {id: 1209:0001, serial: bridge-haptic}
  input: {id: 1209:0002, serial: bridge-input}
joints:
  insertion: {device: haptic, axis: 0, scale: 10 mm/rad, limits: [-1 m, 1 m]}
  rotation: {device: haptic, axis: 1, scale: 1, limits: [-50 rad, 50 rad]}
  tip_up_down: {device: input, axis: 0, scale: 1, limits: [-50 rad, 50 rad]}
  tip_left_right: {device: input, axis: 1, scale: 1, limits: [-50 rad, 50 rad]}
)";
}

/// A spring about kPosition on both axes of the haptic device, in units of the joints.
vibe_msgs::HapticParameters spring() {
  vibe_msgs::HapticParameters message;
  message.touching = true;
  message.joint_name = {"insertion", "rotation", "tip_up_down", "tip_left_right"};
  message.joint_position[0] = kRoller * kPosition;
  message.joint_position[1] = kPosition;
  message.joint_stiffness[0] = kAxisStiffness / (kRoller * kRoller);
  message.joint_stiffness[1] = kAxisStiffness;
  message.joint_damping[0] = kAxisDamping / (kRoller * kRoller);
  message.joint_damping[1] = kAxisDamping;
  return message;
}

class HardwareNode : public testing::Test {
 protected:
  HardwareNode() {
    using JointState = sensor_msgs::JointStateConstPtr;
    ros::NodeHandle& handle = graph_.handle();
    const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
    joints_ = handle.subscribe<sensor_msgs::JointState>(
        "haptic/measured_js", 5000, [this](const JointState& message) { takeJoints(*message); }, {}, no_delay);
    diagnostics_ = handle.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { takeStatus(*message); });
    states_ = handle.subscribe<vibe_msgs::OperatingState>(
        "haptic/operating_state", 10,
        [this](const vibe_msgs::OperatingStateConstPtr& message) { state_ = message->state; });
    parameters_ = handle.advertise<vibe_msgs::HapticParameters>("haptic/parameters", 1);
  }

  void SetUp() override {
    writeConfig();
    hapticDevice().plug();
    inputDevice().plug();
    node_ = RosGraph::start("hardware_node", {std::string("_config:=") + kConfig, "_diagnostic_period:=0.2"});
    ASSERT_TRUE(RosGraph::waitUntil([this] { return !node_->running() || !counts_.empty(); })) << "no message";
    ASSERT_TRUE(node_->running()) << "hardware_node has ended with " << node_->ending()
                                  << "; see its message above, if any";
  }

  void takeJoints(const sensor_msgs::JointState& message) {
    const auto name = std::find(message.name.begin(), message.name.end(), "insertion");
    ASSERT_NE(name, message.name.end());
    const auto i = static_cast<std::size_t>(name - message.name.begin());
    const double angle = message.position.at(i) / kRoller;
    counts_.push_back(static_cast<int>(std::lround(angle / static_cast<double>(AxisConfig{}.radians_per_count))));
    last_stamp_ = message.header.stamp;
    torques_.push_back(message.effort.at(i) * kRoller);
  }

  void takeStatus(const diagnostic_msgs::DiagnosticArray& message) {
    for (const auto& status : message.status) {
      if (status.name.find("haptic") == std::string::npos) continue;
      ++statuses_;
      for (const auto& value : status.values) status_[value.key] = value.value;
    }
  }

  /// The diagnostics as they are after everything that has happened up to now.
  std::map<std::string, std::string> freshStatus() {
    const std::size_t before = statuses_;
    EXPECT_TRUE(RosGraph::waitUntil([&] { return statuses_ >= before + kDiagnosticPeriods; })) << "no diagnostics";
    return status_;
  }

  /// Messages from number `first` on that do not continue the one before: the hand makes 10 counts per report.
  int gapsSince(std::size_t first) const {
    int gaps = 0;
    for (std::size_t i = first + 1; i < counts_.size(); ++i) gaps += std::abs(counts_[i] - counts_[i - 1]) != 10;
    return gaps;
  }

  /// Whether the latest message shows the torque of the spring at its position.
  bool springActs() const {
    constexpr double kTolerance = 4e-4;  // damping and rounding [N m]
    const AxisConfig axis;
    const double angle = counts_.back() * static_cast<double>(axis.radians_per_count);
    const double limit = static_cast<double>(axis.torque_limit);
    const double expected = std::clamp(kAxisStiffness * (kPosition - angle), -limit, limit);
    return std::abs(expected) > 5 * kTolerance && std::abs(torques_.back() - expected) < kTolerance;
  }

  RosGraph graph_;
  std::unique_ptr<ChildProcess> node_;
  ros::Subscriber joints_, diagnostics_, states_;
  ros::Publisher parameters_;
  std::vector<int> counts_;  // of axis 0, in the order of the messages
  ros::Time last_stamp_;
  std::vector<double> torques_;  // of axis 0 [N m]
  std::map<std::string, std::string> status_;
  std::size_t statuses_ = 0;
  std::string state_;
};

/// Publishes the spring at 100 Hz, as the simulator would, while it lives.
class SpringSender {
 public:
  explicit SpringSender(const ros::Publisher& publisher) : thread_([this, publisher] { send(publisher); }) {}
  ~SpringSender() {
    ends_ = true;
    thread_.join();
  }

 private:
  void send(const ros::Publisher& publisher) const {
    for (; !ends_; std::this_thread::sleep_for(std::chrono::milliseconds(10))) publisher.publish(spring());
  }

  std::atomic<bool> ends_{false};
  std::thread thread_;
};

/// Whether stiffness and damping that the device has in force are those of the spring. Its position is not compared:
/// when a device has started anew, the driver shifts the axis so that the joint stays where it was.
bool hasSpring(HidrawFile& device) {
  ParameterReport report;
  const auto bytes = device.getFeature(kParameterReportId);
  if (!unpack(bytes.data(), bytes.size(), report)) return false;
  const auto near = [](double value, double expected) { return std::abs(value - expected) < 1e-5 * expected; };
  return std::all_of(report.axes.begin(), report.axes.end(), [&](const AxisParameters& axis) {
    return near(axis.stiffness, kAxisStiffness) && near(axis.damping, kAxisDamping);
  });
}

/// Waits until the device has the spring. It is asked ten times a second, to leave the bus to the node.
bool waitForSpring(HidrawFile& device) {
  double next = 0;
  return RosGraph::waitUntil([&] {
    if (now() < next) return false;
    next = now() + 0.1;
    return hasSpring(device);
  });
}

TEST_F(HardwareNode, EverySequenceNumberBecomesAMessage) {
  constexpr std::size_t kCount = 500;
  const std::size_t first = counts_.size();
  EXPECT_TRUE(RosGraph::waitUntil([&] { return counts_.size() >= first + kCount; })) << counts_.size() - first;
  EXPECT_EQ(gapsSince(0), 0);
  const auto status = freshStatus();
  for (const char* fault : {"lost", "duplicated", "reordered", "malformed", "implausible"}) {
    EXPECT_EQ(status.at(fault + std::string(" reports")), "0");
  }
  EXPECT_GE(std::stoul(status.at("received reports")), kCount);
  figure("messages of hardware_node in a row without a gap", static_cast<double>(counts_.size()), "");
}

TEST_F(HardwareNode, ALostReportIsCountedAndMissing) {
  const std::size_t first = counts_.size() - 1;
  tellBridge("lose haptic 1");
  const auto is_counted = [this] { return status_.count("lost reports") && status_.at("lost reports") != "0"; };
  EXPECT_TRUE(RosGraph::waitUntil(is_counted)) << "no lost report in the diagnostics";
  EXPECT_EQ(gapsSince(first), 1);
  EXPECT_EQ(freshStatus().at("lost reports"), "1");
}

TEST_F(HardwareNode, HapticParametersReachTheDeviceAndItsTorqueComesBack) {
  HidrawFile device(hapticDevice().plug().hidraw);
  EXPECT_FALSE(hasSpring(device));
  const SpringSender sender(parameters_);
  EXPECT_TRUE(waitForSpring(device));
  EXPECT_TRUE(RosGraph::waitUntil([&] { return state_ == "ENABLED"; })) << state_;
  EXPECT_TRUE(RosGraph::waitUntil([&] { return springActs(); })) << torques_.back() << " N m at " << counts_.back();
  const auto status = freshStatus();
  EXPECT_EQ(status.at("parameters that read back differently"), "0");
  EXPECT_EQ(status.at("refused parameters"), "0");
  EXPECT_GT(std::stoi(status.at("sent parameters")), 0);
}

TEST_F(HardwareNode, AWrongReadBackIsReported) {
  const SpringSender sender(parameters_);
  ASSERT_TRUE(RosGraph::waitUntil([&] { return state_ == "ENABLED"; })) << state_;
  EXPECT_EQ(freshStatus().at("parameters that read back differently"), "0");
  tellBridge("corrupt haptic 10");  // the driver reads more than parameters, and believes only the second difference
  const auto is_reported = [this] { return status_.at("parameters that read back differently") != "0"; };
  EXPECT_TRUE(RosGraph::waitUntil(is_reported)) << testing::PrintToString(status_);
  tellBridge("corrupt haptic 0");
}

TEST_F(HardwareNode, AReplugIsFollowedByMessagesAndTheSameParameters) {
  const SpringSender sender(parameters_);
  ASSERT_TRUE(RosGraph::waitUntil([&] { return state_ == "ENABLED"; })) << state_;
  hapticDevice().unplug();
  const ros::Time pulled = ros::Time::now();
  EXPECT_TRUE(RosGraph::waitUntil([&] { return state_ == "DISABLED"; })) << state_;
  HidrawFile device(hapticDevice().plug().hidraw);  // it has lost its power: parameters are 0 again
  const double plugged = now();
  EXPECT_TRUE(RosGraph::waitUntil([&] { return last_stamp_ > pulled; })) << "no message";
  figure("from the node of the kernel to the first message of hardware_node", 1000 * (now() - plugged), "ms");
  EXPECT_TRUE(waitForSpring(device));
  EXPECT_TRUE(RosGraph::waitUntil([&] { return springActs(); })) << torques_.back() << " N m at " << counts_.back();
  figure("from the node of the kernel to the parameters and the torque of the device", 1000 * (now() - plugged), "ms");
  const auto status = freshStatus();
  EXPECT_EQ(status.at("reconnects"), "1");
  EXPECT_EQ(status.at("parameters that read back differently"), "0");
}

}  // namespace
}  // namespace vibe::hardware
