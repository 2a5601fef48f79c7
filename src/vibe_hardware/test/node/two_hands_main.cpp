// A person with two arms in a ROS graph takes a whole bite: one hand at the scope, one at the suturing device, each arm
// with a crtk_teleop of its own. Arguments: four pairs of an arm's namespace and its mapping; the third arm follows the
// first when the stomach is blown up, and the fourth the second when the helix is wound in, as soon as nobody listens
// to the one before any more. Prints the row of docs/hardware.md and how far joints moved at each hand-over; on failure
// what did not happen.

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

constexpr double kUnnoticed = 1e-3, kUnnoticedTurn = M_PI / 180;  // at a hand-over [m], [rad]
constexpr std::size_t kHands = 2, kDevice = 1;                    // the first one is at the scope
constexpr int kRest = 30;                                         // frames for which the tool must rest
constexpr double kPatience = 60;                                  // [s]

class TwoHands : public HeldArms<GraphStomach> {
 public:
  TwoHands(const std::vector<std::string>& names, const std::vector<std::string>& mappings) {
    const ToolLimits limits = loadToolLimits(resolveAddress("package://vibe_description/urdf/scope.urdf"));
    for (std::size_t i = 0; i < names.size(); ++i) {
      arms_.emplace_back(loadTeleopMapping(mappings[i], limits));
      if (i >= kHands) putAside(arms_[i]);
      connect(names[i]);
    }
    commands_ = {handle_.subscribe("scope/servo_jp", 10, &TwoHands::onCommand<0>, this),
                 handle_.subscribe("suturing_device/servo_jp", 10, &TwoHands::onCommand<1>, this)};
  }

  /// Until the simulator is there and both hands drive.
  bool begin() {
    return waitFor([this] { return sees() && driven_[0] > 0 && driven_[1] > 0; });
  }

  test::SeenByHand look() override {
    if (arms_.size() > kHands && !arms_[kDevice].waits && seen().count(Event::Kind::HelixTurned) > 0) handOver();
    return HeldArms::look();
  }

  const std::vector<std::string>& failures() const { return failures_; }

 protected:
  void send(double dt) override {
    const int count = std::max(1, static_cast<int>(std::lround(dt / 1e-3)));
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      if (arms_[i].waits) continue;
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
  std::vector<std::string> failures_;

  /// Elsewhere than the arm that it takes over from, and half closed.
  static void putAside(HeldArm& arm) {
    arm.waits = true;
    arm.hand[HandX] = 0.02;
    arm.motion.position = arm.mapping.hand.col(0) * arm.hand[HandX];
    arm.angle = 0.5 * (arm.mapping.gripper->open + arm.mapping.gripper->closed);
  }

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

  /// Until no joint moves.
  bool rest() {
    auto joints = seen().joints;
    int frames = 0;
    return waitFor([&] {
      frames = seen().joints == joints ? frames + 1 : 0;
      joints = seen().joints;
      return frames > kRest;
    });
  }

  void handOver() {
    if (!waitFor([&] { return links_[kDevice].pose.getNumSubscribers() == 0; }))
      failures_.emplace_back("a node did not end");
    arms_[kDevice].waits = true;
    rest();
    const auto before = seen().joints;
    const int driven = driven_[kDevice];
    arms_[kHands].waits = false;
    if (!waitFor([&] { return driven_[kDevice] > driven + 2 * kRest; }) || !rest())
      failures_.emplace_back("the next arm does not drive");
    double slid = 0, turned = 0;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const bool slides = j == Insertion || j == HelixAdvance || j == NeedleDriver;
      double& most = slides ? slid : turned;
      most = std::max(most, std::abs(seen().joints[j] - before[j]));
    }
    std::printf("hand-over of the device: joints moved by at most %.3f mm, %.3f degrees\n", 1e3 * slid,
                turned * 180 / M_PI);
    std::fflush(stdout);
    if (slid > kUnnoticed || turned > kUnnoticedTurn) failures_.emplace_back("a joint jumped at a hand-over");
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
  for (const std::string& other : hands.failures()) std::printf("%s\n", other.c_str());
  return failure.empty() && hands.failures().empty() ? 0 : 1;
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
