#include "vibe_hardware/crtk/teleop_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/input/joint_unit.hpp"
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
        mapOf(source_.root(),
              {"name", "pose", "hand", "joints", "arm", "forces", "clutch", "buttons", "gripper", "device"}, {"name"});
    mapping_.name = source_.text(fields.at("name"));
    const auto hand = fields.find("hand");
    if (hand != fields.end()) readHand(hand->second);
    if (fields.count("arm") > 0) readArm(fields.at("arm"));
    if (fields.count("joints") > 0) readJoints(fields.at("joints"), 0, kScopeJointCount);
    if (fields.count("gripper") > 0) readGripper(fields.at("gripper"));
    if (fields.count("device") > 0) readDevice(fields.at("device"));
    if (fields.count("joints") == 0 && !mapping_.device_only)
      source_.fail(source_.root(),
                   "lacks the key 'joints'; add it, or 'device' without a button for an arm that moves only the "
                   "suturing device");
    if (fields.count("joints") > 0 && mapping_.device_only)
      source_.fail(fields.at("device"),
                   "needs the button that changes over, since the arm moves joints of the scope, too; add 'button'");
    if (fields.count("pose") > 0) mapping_.pose_topic = source_.text(fields.at("pose"));
    if (mapping_.arm_joints.empty() && hand == fields.end())
      source_.fail(source_.root(), "lacks the key 'hand'; add it below");
    if (!mapping_.arm_joints.empty() && hand != fields.end())
      source_.fail(hand->second,
                   "is for an arm that measures a pose, and this one is mapped by its joints; leave it out");
    if (fields.count("pose") > 0 && !mapping_.arm_joints.empty())
      source_.fail(fields.at("pose"),
                   "is for an arm that measures a pose, and this one is mapped by its joints; leave it out");
    if (fields.count("forces") > 0) readForces(fields.at("forces"));
    if (fields.count("clutch") > 0) mapping_.clutch = readControl(fields.at("clutch"));
    if (fields.count("buttons") > 0) readButtons(fields.at("buttons"));
    chooseTwist();
    return mapping_;
  }

 private:
  using Fields = std::map<std::string, YamlField>;

  const YamlSource& source_;
  const ToolLimits& limits_;
  TeleopMapping mapping_;
  PortConfig way_, turn_ = turnOf(way_);                     // of coordinates along and about an axis
  std::map<int, std::string> used_;                          // coordinates
  bool any_pose_ = false;                                    // a motion of the hand moves a joint
  std::vector<std::pair<ArmButton, std::string>> controls_;  // that are used, with the paths of their keys
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
    const Fields fields = mapOf(field, {"button", "joints"}, {"joints"});
    mapping_.device_only = fields.count("button") == 0;
    if (!mapping_.device_only) mapping_.device = readControl(fields.at("button"));
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

  /// Of clutch and device.
  ArmButton readControl(const YamlField& field) {
    const Fields fields = mapOf(field, {"topic", "button", "reversed"}, {"topic"});
    ArmButton button = readTopic(fields);
    if (fields.count("reversed") > 0) button.reversed = source_.boolean(fields.at("reversed"));
    return use(button, field);
  }

  /// Of the procedure.
  ArmButton readButton(const YamlField& field) {
    const Fields fields = mapOf(field, {"topic", "button", "mode", "while"}, {"topic"});
    ArmButton button = readTopic(fields);
    if (fields.count("mode") > 0) button.toggle = source_.choice(fields.at("mode"), {"hold", "toggle"}) == "toggle";
    if (fields.count("while") == 0) return use(button, field);
    if (mapping_.device.topic.empty())
      source_.fail(fields.at("while"), "needs an arm that changes over; add 'device' with its button, or leave it out");
    const bool scope = source_.choice(fields.at("while"), {"scope", "device"}) == "scope";
    button.during = scope ? ArmButton::While::Scope : ArmButton::While::Device;
    return use(button, field);
  }

  ArmButton readTopic(const Fields& fields) const {
    ArmButton button;
    button.topic = source_.text(fields.at("topic"));
    if (fields.count("button") > 0) button.index = static_cast<int>(source_.integer(fields.at("button"), 0, 63));
    return button;
  }

  /// One control does two things only if one is while the arm moves the scope and the other while it does not.
  const ArmButton& use(const ArmButton& button, const YamlField& field) {
    for (const auto& [other, path] : controls_) {
      const bool apart = other.during != button.during && other.during != ArmButton::While::Always &&
                         button.during != ArmButton::While::Always;
      if (other.topic == button.topic && other.index == button.index && !apart)
        source_.fail(field, "is the control of " + path +
                                " already; take another one, or give both 'while', one scope and the other device");
    }
    controls_.emplace_back(button, field.path);
    return button;
  }

  void readButtons(const YamlField& field) {
    const std::vector<std::string> names(kButtonNames.begin(), kButtonNames.end());
    for (const auto& [name, entry] : mapOf(field, names, {})) {
      const auto index = std::find(names.begin(), names.end(), name) - names.begin();
      if (mapping_.gripper && mapping_.gripper->button == index)
        source_.fail(entry, "is pressed by the gripper already; leave it out here or there");
      mapping_.buttons[static_cast<std::size_t>(index)] = readButton(entry);
    }
  }

  void readGripper(const YamlField& field) {
    const Fields fields =
        mapOf(field, {"topic", "joint", "button", "closed", "open", "at_closed", "at_open"}, {"closed", "open"});
    const bool joint = fields.count("joint") > 0;
    if (joint == (fields.count("button") > 0) || joint != (fields.count("at_closed") > 0) ||
        joint != (fields.count("at_open") > 0))
      source_.fail(field,
                   "needs either joint, at_closed and at_open, or button; write for example 'button: helix_grab'");
    ArmGripper gripper;
    if (fields.count("topic") > 0) gripper.topic = source_.text(fields.at("topic"));
    readIf(fields, "closed", "rad", -7, 7, gripper.closed);
    readIf(fields, "open", "rad", -7, 7, gripper.open);
    if (std::abs(gripper.open - gripper.closed) < 1e-3)
      source_.fail(fields.at("open"), "is the angle of 'closed', too; write two angles that differ");
    if (joint)
      readGripperJoint(fields, gripper);
    else
      gripper.button = indexIn({kButtonNames.begin(), kButtonNames.end()}, fields.at("button"));
    mapping_.gripper = gripper;
  }

  int indexIn(const std::vector<std::string>& names, const YamlField& field) const {
    return static_cast<int>(std::find(names.begin(), names.end(), source_.choice(field, names)) - names.begin());
  }

  void readGripperJoint(const Fields& fields, ArmGripper& gripper) const {
    gripper.joint =
        kScopeJointCount + indexIn({kJointNames.begin() + kScopeJointCount, kJointNames.end()}, fields.at("joint"));
    const JointLimits& limits = limits_[static_cast<std::size_t>(gripper.joint)];
    const double spare = 1e-6 * (limits.upper - limits.lower);  // the digits that the writer of the URDF chose
    for (const auto& [key, place] : {std::pair{"at_closed", &gripper.at_closed}, {"at_open", &gripper.at_open}}) {
      readIf(fields, key, jointUnit(gripper.joint), limits.lower - spare, limits.upper + spare, *place);
      *place = std::clamp(*place, limits.lower, limits.upper);
    }
  }
};

}  // namespace

bool pressesButtons(const TeleopMapping& mapping) {
  return (mapping.gripper && mapping.gripper->button >= 0) ||
         std::any_of(mapping.buttons.begin(), mapping.buttons.end(),
                     [](const ArmButton& b) { return !b.topic.empty(); });
}

std::vector<std::string> unreachable(const TeleopMapping& mapping) {
  const ArmGripper gripper = mapping.gripper.value_or(ArmGripper());
  std::vector<std::string> names;
  for (int j = 0; j < kJointCount; ++j)
    if (mapping.joints[static_cast<std::size_t>(j)].coordinate < 0 && gripper.joint != j)
      names.emplace_back(kJointNames[static_cast<std::size_t>(j)]);
  for (int b = 0; b < kButtonCount; ++b)
    if (mapping.buttons[static_cast<std::size_t>(b)].topic.empty() && gripper.button != b)
      names.emplace_back(kButtonNames[static_cast<std::size_t>(b)]);
  return names;
}

TeleopMapping loadTeleopMapping(const std::string& file, const ToolLimits& limits) {
  return ArmReader(YamlSource::load(file, kArmFile), limits).read();
}

TeleopMapping parseTeleopMapping(const std::string& text, const std::string& place, const ToolLimits& limits) {
  return ArmReader(YamlSource::parse(text, place, kArmFile), limits).read();
}

}  // namespace vibe::hardware
