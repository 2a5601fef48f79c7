// A person with two arms in a ROS graph takes a whole bite: one hand at the scope, one at the suturing device, each arm
// with a crtk_teleop of its own. Arguments: two pairs of an arm's namespace and its mapping. Prints the row of
// docs/hardware.md; on failure what did not happen.

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/Joy.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "graph_stomach.hpp"
#include "hands/held_arms.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace vibe::hardware {
namespace {

constexpr std::size_t kHands = 2;  // the first one is at the scope
constexpr double kPatience = 60;   // [s]

class TwoHands : public HeldArms<GraphStomach> {
 public:
  TwoHands(const std::vector<std::string>& names, const std::vector<std::string>& mappings) {
    const ToolLimits limits = loadToolLimits(resolveAddress("package://vibe_description/urdf/scope.urdf"));
    for (std::size_t i = 0; i < names.size(); ++i) {
      arms_.emplace_back(loadTeleopMapping(mappings[i], limits));
      connect(names[i]);
    }
    commands_ = {handle_.subscribe("scope/servo_jp", 10, &TwoHands::onCommand<0>, this),
                 handle_.subscribe("suturing_device/servo_jp", 10, &TwoHands::onCommand<1>, this)};
  }

  /// Until the simulator is there and both hands drive.
  bool begin() {
    return waitFor([this] { return sees() && driven_[0] > 0 && driven_[1] > 0; });
  }

 protected:
  void send(double dt) override {
    const int count = std::max(1, static_cast<int>(std::lround(dt / 1e-3)));
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      for (int k = 0; k < count; ++k) moveArm(arms_[i], dt / count);
      publish(arms_[i], links_[i]);
    }
  }

  void pressed(const ArmButton& control, bool down) override {
    sensor_msgs::Joy message;
    message.header.stamp = ros::Time::now();
    message.buttons.assign(static_cast<std::size_t>(control.index) + 1, 0);
    message.buttons.back() = down ? 1 : 0;
    pedals_.at(control.topic).publish(message);
    ++commands;
  }

 private:
  struct Link {
    ros::Publisher pose, gripper;
    ros::Subscriber force;
  };
  std::vector<Link> links_;  // by arm
  std::map<std::string, ros::Publisher> pedals_;
  std::vector<ros::Subscriber> commands_;
  std::array<int, kHands> driven_{};                // commands to the scope and to its device
  std::array<std::vector<double>, kHands> sent_{};  // the last ones

  void connect(const std::string& name) {
    const TeleopMapping& map = arms_.back().mapping;
    Link link;
    link.pose = handle_.advertise<geometry_msgs::PoseStamped>(name + "/" + map.pose_topic, 10);
    if (map.gripper) link.gripper = handle_.advertise<sensor_msgs::JointState>(name + "/" + map.gripper->topic, 10);
    const std::size_t i = links_.size();
    const boost::function<void(const geometry_msgs::WrenchStamped&)> feels =
        [this, i](const geometry_msgs::WrenchStamped& m) {
          const auto &f = m.wrench.force, &t = m.wrench.torque;
          feel(arms_[i], {f.x, f.y, f.z}, {t.x, t.y, t.z});
        };
    link.force = handle_.subscribe<geometry_msgs::WrenchStamped>(name + "/" + map.force_topic, 10, feels);
    links_.push_back(link);
    advertise(map.clutch);
    for (const ArmButton& button : map.buttons) advertise(button);
  }

  void advertise(const ArmButton& button) {
    if (button.topic.empty() || pedals_.count(button.topic) > 0) return;
    pedals_[button.topic] = handle_.advertise<sensor_msgs::Joy>(button.topic, 10, true);
    pressed(button, false);
  }

  template <std::size_t part>
  void onCommand(const sensor_msgs::JointState& message) {
    ++driven_[part];
    if (message.position != sent_[part]) ++commands;
    sent_[part] = message.position;
  }

  static void publish(const HeldArm& arm, const Link& link) {
    geometry_msgs::PoseStamped pose;
    pose.header.stamp = ros::Time::now();
    pose.header.frame_id = "arm_base";
    const Eigen::Vector3d& p = arm.motion.position;
    const Eigen::Quaterniond q = orientationOf(arm.motion);
    pose.pose.position.x = p.x(), pose.pose.position.y = p.y(), pose.pose.position.z = p.z();
    pose.pose.orientation.x = q.x(), pose.pose.orientation.y = q.y();
    pose.pose.orientation.z = q.z(), pose.pose.orientation.w = q.w();
    link.pose.publish(pose);
    if (!arm.mapping.gripper) return;
    sensor_msgs::JointState gripper;
    gripper.header = pose.header;
    gripper.position = {arm.angle};
    link.gripper.publish(gripper);
  }

  template <class Come>
  bool waitFor(const Come& come) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience);
    while (ros::ok() && !come() && ros::WallTime::now() < end) frame();
    return come();
  }
};

int run(const std::vector<std::string>& names, const std::vector<std::string>& mappings) {
  TwoHands hands(names, mappings);
  if (!hands.begin()) return std::printf("The arms do not drive.\n"), 1;
  hands.commands = 0;
  test::BiteOperator person(hands);
  const std::string failure = person.bite();
  std::printf("| two nodes | %.1f | %d | %.2f |\n%s\n", person.seconds(), hands.commands, person.force(),
              failure.c_str());
  return failure.empty() ? 0 : 1;
}

}  // namespace
}  // namespace vibe::hardware

int main(int argc, char** argv) {
  int status = 2;
  const int node = vibe::ros_utils::runNode(argc, argv, "person", [&] {
    std::vector<std::string> names, mappings;
    for (int i = 1; i + 1 < argc; i += 2) names.emplace_back(argv[i]), mappings.emplace_back(argv[i + 1]);
    if (names.size() >= 2) status = vibe::hardware::run(names, mappings);
  });
  return node != 0 ? node : status;
}
