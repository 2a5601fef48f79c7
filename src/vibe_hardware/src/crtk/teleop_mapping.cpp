#include "vibe_hardware/crtk/teleop_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::hardware {
namespace {

constexpr YamlLimits kArmFile{1 << 16, 8};
constexpr double kTurnResolution = 1e-3;  // of the wrist of an arm [rad]; design choice
constexpr double kTurnEnergy = 0.2;       // share of the energy of a translation that a rotation gets; design choice

const std::vector<std::string> kDirections{"x", "-x", "y", "-y", "z", "-z"};

Eigen::Vector3d directionOf(const std::string& word) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  direction[word.back() - 'x'] = word.front() == '-' ? -1 : 1;
  return direction;
}

PortConfig turnOf(const PortConfig& way) {
  return {way.delay, way.hold, 5, kTurnResolution, 0, 0.005, kTurnEnergy * way.capacity};
}

/// Reads a TeleopMapping out of a YAML document.
class ArmReader {
 public:
  ArmReader(const YamlSource& source, const ToolLimits& limits) : source_(source), limits_(limits) {}

  TeleopMapping read() {
    const Fields fields =
        mapOf(source_.root(), {"name", "hand", "joints", "arm", "forces", "clutch", "buttons", "gripper", "device"},
              {"name", "joints"});
    mapping_.name = source_.text(fields.at("name"));
    const auto hand = fields.find("hand");
    if (hand != fields.end()) readHand(hand->second);
    if (fields.count("arm") > 0) readArm(fields.at("arm"));
    readJoints(fields.at("joints"), 0, kScopeJointCount);
    if (mapping_.arm_joints.empty() && hand == fields.end())
      source_.fail(source_.root(), "lacks the key 'hand'; add it below");
    if (!mapping_.arm_joints.empty() && hand != fields.end())
      source_.fail(hand->second,
                   "is for an arm that measures a pose, and this one is mapped by its joints; leave it out");
    if (fields.count("forces") > 0) readForces(fields.at("forces"));
    if (fields.count("clutch") > 0) mapping_.clutch = readButton(fields.at("clutch"));
    if (fields.count("buttons") > 0) readButtons(fields.at("buttons"));
    if (fields.count("gripper") > 0) readGripper(fields.at("gripper"));
    if (fields.count("device") > 0) readDevice(fields.at("device"));
    chooseTwist();
    return mapping_;
  }

 private:
  using Fields = std::map<std::string, YamlField>;

  const YamlSource& source_;
  const ToolLimits& limits_;
  TeleopMapping mapping_;
  PortConfig way_, turn_ = turnOf(way_);  // of coordinates along and about an axis
  std::map<int, std::string> used_;       // coordinates
  bool any_pose_ = false;                 // a motion of the hand moves a joint
  std::string stylus_;  // axis of the moving frame; empty: the one that is named as the twist's in the base

  Fields mapOf(const YamlField& field, const std::vector<std::string>& known,
               const std::vector<std::string>& required) const {
    Fields fields;
    for (const YamlField& entry : source_.map(field, known, required)) fields.emplace(entry.key, entry);
    return fields;
  }

  void readIf(const Fields& fields, const char* key, const char* unit, double low, double high, double& value) const {
    const auto found = fields.find(key);
    if (found != fields.end()) value = source_.quantity(found->second, unit, low, high);
  }

  void readHand(const YamlField& field) {
    const Fields fields = mapOf(field, {"away", "up", "stylus"}, {"away", "up"});
    if (fields.count("stylus") > 0) stylus_ = source_.choice(fields.at("stylus"), kDirections);
    const std::string away = source_.choice(fields.at("away"), kDirections);
    const std::string up = source_.choice(fields.at("up"), kDirections);
    if (away.back() == up.back())
      source_.fail(fields.at("up"), "is along the same axis as 'away'; name two axes of the arm's base");
    const Eigen::Vector3d x = directionOf(away), z = directionOf(up);
    mapping_.hand.col(0) = x;
    mapping_.hand.col(1) = z.cross(x);
    mapping_.hand.col(2) = z;
  }

  /// The twist is what turns the scope, else what turns the helix, else the motion about the way away.
  void chooseTwist() {
    for (const Joint joint : {HelixRotation, Rotation})
      if (mapping_.joints[joint].coordinate >= HandRoll) mapping_.twist = mapping_.joints[joint].coordinate - HandRoll;
    mapping_.stylus = stylus_.empty() ? Eigen::Vector3d(mapping_.hand.col(mapping_.twist)) : directionOf(stylus_);
  }

  void readArm(const YamlField& field) {
    const Fields fields = mapOf(field,
                                {"delay", "timeout", "energy", "speed_limit", "turn_limit", "force_limit",
                                 "torque_limit", "damping_limit", "turn_damping_limit", "resolution"},
                                {});
    readIf(fields, "timeout", "s", 0.02, 2, mapping_.timeout);
    readIf(fields, "delay", "s", 0, 0.5, way_.delay);
    readIf(fields, "energy", "J", 1e-4, 1, way_.capacity);
    turn_ = turnOf(way_);
    readIf(fields, "speed_limit", "m/s", 0.01, 10, way_.speed_limit);
    readIf(fields, "turn_limit", "rad/s", 0.1, 100, turn_.speed_limit);
    readIf(fields, "force_limit", "N", 0, 100, way_.force_limit);
    readIf(fields, "torque_limit", "N*m", 0, 10, turn_.force_limit);
    readIf(fields, "damping_limit", "N*s/m", 0, 100, way_.damping_limit);
    readIf(fields, "turn_damping_limit", "N*m*s/rad", 0, 10, turn_.damping_limit);
    readIf(fields, "resolution", "m", 0, 0.01, way_.resolution);
  }

  void readJoints(const YamlField& field, int first, int end) {
    used_.clear();
    const std::vector<std::string> names(kJointNames.begin() + first, kJointNames.begin() + end);
    for (const auto& [name, entry] : mapOf(field, names, {})) {
      const int joint = first + static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
      if (mapping_.gripper && mapping_.gripper->joint == joint)
        source_.fail(entry, "is set by the gripper already; leave it out here or there");
      readJoint(entry, joint, mapping_.joints[static_cast<std::size_t>(joint)]);
    }
    if (used_.empty())
      source_.fail(field, "moves nothing; write at least one joint of the " +
                              std::string(first == 0 ? "scope" : "suturing device"));
  }

  void readDevice(const YamlField& field) {
    const Fields fields = mapOf(field, {"button", "joints"}, {"button", "joints"});
    mapping_.device = readButton(fields.at("button"));
    readJoints(fields.at("joints"), kScopeJointCount, kJointCount);
  }

  void readJoint(const YamlField& field, int index, HandJoint& joint) {
    const Fields fields = mapOf(field, {"along", "about", "slide", "turn", "scale"}, {"scale"});
    if (fields.size() != 2)
      source_.fail(field, "needs exactly one of along, about, slide and turn; write for example 'along: x'");
    const bool along = fields.count("along") + fields.count("slide") > 0;
    const bool pose = fields.count("along") + fields.count("about") > 0;
    any_pose_ |= pose;
    const YamlField& axis = fields.at(pose ? (along ? "along" : "about") : (along ? "slide" : "turn"));
    joint.coordinate =
        pose ? source_.choice(axis, {"x", "y", "z"}).front() - 'x' + (along ? HandX : HandRoll) : armJoint(axis);
    if (pose != mapping_.arm_joints.empty())
      source_.fail(axis,
                   "is a motion of the hand, and other joints are moved by joints of the arm; an arm is mapped by "
                   "its pose or by its joints");
    const auto [other, is_new] = used_.emplace(joint.coordinate, field.path);
    if (!is_new) source_.fail(axis, "is used by " + other->second + " already; use each motion of the hand once");
    const std::string top = jointUnit(index), below = along ? "m" : "rad";
    joint.scale = source_.quantity(fields.at("scale"), top == below ? "1" : top + "/" + below, -1e3, 1e3);
    if (std::abs(joint.scale) < 1e-6) source_.fail(fields.at("scale"), "is 0; leave the joint out to keep it still");
    joint.port = along ? way_ : turn_;
  }

  /// Index of a joint of the arm that is named.
  int armJoint(const YamlField& field) {
    std::vector<std::string>& names = mapping_.arm_joints;
    if (any_pose_)
      source_.fail(field,
                   "is a joint of the arm, and other joints are moved by its pose; an arm is mapped by its pose or "
                   "by its joints");
    const std::string name = source_.text(field);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    if (names.size() == kHandCoordinates) source_.fail(field, "is a seventh joint of the arm; six can be used");
    names.push_back(name);
    mapping_.force_topic = "servo_jf";
    return static_cast<int>(names.size()) - 1;
  }

  void readForces(const YamlField& field) {
    const Fields fields = mapOf(field, {"topic", "axes", "scale"}, {});
    if (fields.count("topic") > 0) mapping_.force_topic = source_.text(fields.at("topic"));
    if (fields.count("axes") > 0 && !mapping_.arm_joints.empty())
      source_.fail(fields.at("axes"), "is for forces on a pose, and this arm is mapped by its joints; leave it out");
    if (fields.count("axes") > 0)
      mapping_.force_frame =
          source_.choice(fields.at("axes"), {"base", "body"}) == "body" ? ForceFrame::Body : ForceFrame::Base;
    readIf(fields, "scale", "1", 0, 100, mapping_.force_scale);
  }

  ArmButton readButton(const YamlField& field) const {
    const Fields fields = mapOf(field, {"topic", "button"}, {"topic"});
    ArmButton button{source_.text(fields.at("topic")), 0};
    if (fields.count("button") > 0) button.index = static_cast<int>(source_.integer(fields.at("button"), 0, 63));
    return button;
  }

  void readButtons(const YamlField& field) {
    const std::vector<std::string> names(kButtonNames.begin(), kButtonNames.end());
    for (const auto& [name, entry] : mapOf(field, names, {}))
      mapping_.buttons[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())] =
          readButton(entry);
  }

  void readGripper(const YamlField& field) {
    const Fields fields = mapOf(field, {"joint", "closed", "open", "at_closed", "at_open"},
                                {"joint", "closed", "open", "at_closed", "at_open"});
    const std::vector<std::string> names(kJointNames.begin() + kScopeJointCount, kJointNames.end());
    const std::string name = source_.choice(fields.at("joint"), names);
    ArmGripper gripper;
    gripper.joint = kScopeJointCount + static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
    readIf(fields, "closed", "rad", -7, 7, gripper.closed);
    readIf(fields, "open", "rad", -7, 7, gripper.open);
    if (std::abs(gripper.open - gripper.closed) < 1e-3)
      source_.fail(fields.at("open"), "is the angle of 'closed', too; write two angles that differ");
    const JointLimits& limits = limits_[static_cast<std::size_t>(gripper.joint)];
    const double spare = 1e-6 * (limits.upper - limits.lower);  // the digits that the writer of the URDF chose
    for (const auto& [key, place] : {std::pair{"at_closed", &gripper.at_closed}, {"at_open", &gripper.at_open}}) {
      readIf(fields, key, jointUnit(gripper.joint), limits.lower - spare, limits.upper + spare, *place);
      *place = std::clamp(*place, limits.lower, limits.upper);
    }
    mapping_.gripper = gripper;
  }
};

}  // namespace

TeleopMapping loadTeleopMapping(const std::string& file, const ToolLimits& limits) {
  return ArmReader(YamlSource::load(file, kArmFile), limits).read();
}

TeleopMapping parseTeleopMapping(const std::string& text, const std::string& place, const ToolLimits& limits) {
  return ArmReader(YamlSource::parse(text, place, kArmFile), limits).read();
}

}  // namespace vibe::hardware
