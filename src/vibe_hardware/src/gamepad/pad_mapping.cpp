#include "vibe_hardware/gamepad/pad_mapping.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <linux/input-event-codes.h>

#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/input/joint_unit.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_hardware/gamepad/pad_state.hpp"

namespace vibe::hardware {
namespace {

constexpr double kDefaultDeadZone = 0.12;  // of sticks that do not return to their middle exactly (design choice)
constexpr double kDefaultExponent = 2;     // fine motion near the middle (design choice)
constexpr double kLargestEffort = 100;     // [N], [N m]
constexpr double kRounding = 1e-6;         // of a range: a URDF has the digits of 90 deg that its writer chose

const YamlField* find(const std::vector<YamlField>& entries, const std::string& key) {
  for (const YamlField& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

/// All names of a type, for hints.
std::vector<std::string> codeNames(int type) {
  std::vector<std::string> names;
  const int count = type == EV_ABS ? ABS_CNT : KEY_CNT;
  for (int code = 0; code < count; ++code) {
    const std::string name = eventCodeName(type, code);
    if (eventCodeFromName(type, name) == code) names.push_back(name);
  }
  return names;
}

/// So many digits that a limit which is copied from a message is within kRounding of it.
std::string show(double value, const std::string& unit) {
  return formatted("%.7g ", value) + unit;
}

template <std::size_t N>
int indexOf(const std::array<const char*, N>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

template <std::size_t N>
std::vector<std::string> listOf(const std::array<const char*, N>& names) {
  return {names.begin(), names.end()};
}

constexpr YamlLimits kLimits{1 << 16, 8};

}  // namespace

/// Reads a PadMapping out of a YAML document.
class PadMappingReader {
 public:
  PadMappingReader(const YamlSource& source, const ToolLimits& limits) : source_(source), limits_(limits) {}

  PadMapping read() {
    const YamlField root = source_.root();
    const std::vector<YamlField> fields = source_.map(root, {"name", "joints", "buttons", "feedback", "joy"});
    if (find(fields, "name") == nullptr) source_.fail(root, "has no name; write 'name: ...'");
    mapping_.name = source_.text(*find(fields, "name"));
    if (const YamlField* joints = find(fields, "joints")) readJoints(*joints);
    if (const YamlField* buttons = find(fields, "buttons")) readButtons(*buttons);
    if (const YamlField* feedback = find(fields, "feedback")) readFeedback(*feedback);
    if (const YamlField* joy = find(fields, "joy")) readJoy(*joy);
    if (used_.empty()) source_.fail(root, "moves nothing; write at least one joint below 'joints:'");
    return mapping_;
  }

 private:
  const YamlSource& source_;
  const ToolLimits& limits_;
  PadMapping mapping_;
  std::map<std::pair<int, int>, std::string> used_;  // event type and code -> path of the key that uses it

  void readJoints(const YamlField& field) {
    for (const YamlField& entry : source_.map(field)) {
      const int joint = indexOf(kJointNames, entry.key);
      if (joint < 0) source_.fail(entry, "is not a joint; " + suggestKey(entry.key, listOf(kJointNames)));
      readJoint(entry, joint);
    }
  }

  void readJoint(const YamlField& field, int index) {
    const std::vector<YamlField> entries = source_.map(field, {"axis", "axes", "buttons", "mode", "rate", "range",
                                                               "dead_zone", "exponent", "reversed", "full_effort"});
    JointMapping& joint = mapping_.joints[static_cast<std::size_t>(index)];
    readControl(field, entries, joint);
    readMotion(field, entries, index, joint);
    const bool is_rate = joint.mode == JointMapping::Mode::Rate && joint.control != JointMapping::Control::Buttons;
    joint.dead_zone = is_rate ? kDefaultDeadZone : 0;
    joint.exponent = is_rate ? kDefaultExponent : 1;
    if (const YamlField* zone = find(entries, "dead_zone")) joint.dead_zone = source_.quantity(*zone, "1", 0, 0.9);
    if (const YamlField* power = find(entries, "exponent")) joint.exponent = source_.quantity(*power, "1", 0.2, 5);
    if (const YamlField* reversed = find(entries, "reversed")) joint.reversed = source_.boolean(*reversed);
  }

  void readControl(const YamlField& field, const std::vector<YamlField>& entries, JointMapping& joint) {
    const YamlField* axis = find(entries, "axis");
    const YamlField* axes = find(entries, "axes");
    const YamlField* buttons = find(entries, "buttons");
    const int count = (axis != nullptr) + (axes != nullptr) + (buttons != nullptr);
    if (count != 1) source_.fail(field, "needs exactly one of axis, axes and buttons; write for example 'axis: ABS_X'");
    if (axis != nullptr) {
      joint.control = JointMapping::Control::Axis;
      joint.forward = code(*axis, EV_ABS);
    } else if (axes != nullptr) {
      joint.control = JointMapping::Control::Axes;
      readPair(*axes, EV_ABS, joint);
    } else {
      joint.control = JointMapping::Control::Buttons;
      readPair(*buttons, EV_KEY, joint);
    }
  }

  void readMotion(const YamlField& field, const std::vector<YamlField>& entries, int index, JointMapping& joint) {
    const YamlField* mode = find(entries, "mode");
    if (mode == nullptr) source_.fail(field, "has no mode; write 'mode: rate' or 'mode: position'");
    if (source_.choice(*mode, {"rate", "position"}) == "position") return readPosition(field, entries, index, joint);
    for (const char* key : {"range", "full_effort"})
      if (const YamlField* wrong = find(entries, key))
        source_.fail(*wrong, "goes with 'mode: position' only; remove it");
    const YamlField* rate = find(entries, "rate");
    if (rate == nullptr) source_.fail(field, "has no rate, the speed at full deflection; write 'rate: ...'");
    const double fastest = limits_[static_cast<std::size_t>(index)].velocity;
    joint.rate = within(*rate, jointSpeedUnit(index), 0, fastest);
  }

  void readPosition(const YamlField& field, const std::vector<YamlField>& entries, int index, JointMapping& joint) {
    joint.mode = JointMapping::Mode::Position;
    if (joint.control != JointMapping::Control::Axis)
      source_.fail(field, "has no axis to take a position from; write 'axis: ...' or 'mode: rate'");
    if (const YamlField* rate = find(entries, "rate")) source_.fail(*rate, "goes with 'mode: rate' only; remove it");
    const YamlField* range = find(entries, "range");
    if (range == nullptr) source_.fail(field, "has no range; write 'range: [lowest, highest]'");
    const JointLimits& limits = limits_[static_cast<std::size_t>(index)];
    const std::vector<YamlField> ends = source_.list(*range);
    if (ends.size() != 2) source_.fail(*range, "needs two values; write [lowest, highest]");
    joint.low = within(ends[0], jointUnit(index), limits.lower, limits.upper);
    joint.high = within(ends[1], jointUnit(index), limits.lower, limits.upper);
    if (!(joint.low < joint.high))
      source_.fail(*range, "has its ends in the wrong order; write [lowest, highest] and 'reversed: true' if needed");
    if (const YamlField* effort = find(entries, "full_effort"))
      joint.full_effort = source_.quantity(*effort, isPrismatic(index) ? "N" : "N*m", 0, kLargestEffort);
  }

  void readButtons(const YamlField& field) {
    for (const YamlField& entry : source_.map(field)) {
      const int index = indexOf(kButtonNames, entry.key);
      if (index < 0) source_.fail(entry, "is not a button; " + suggestKey(entry.key, listOf(kButtonNames)));
      const std::vector<YamlField> parts = source_.map(entry, {"button", "mode"});
      const YamlField* button = find(parts, "button");
      if (button == nullptr) source_.fail(entry, "has no button; write for example 'button: BTN_SOUTH'");
      ButtonMapping& result = mapping_.buttons[static_cast<std::size_t>(index)];
      result.code = code(*button, EV_KEY);
      if (const YamlField* mode = find(parts, "mode"))
        result.toggle = source_.choice(*mode, {"hold", "toggle"}) == "toggle";
    }
  }

  void readFeedback(const YamlField& field) {
    const std::vector<YamlField> entries = source_.map(field, {"rumble_force"});
    if (const YamlField* force = find(entries, "rumble_force"))
      mapping_.feedback.rumble_force = source_.quantity(*force, "N", 0, kLargestEffort);
  }

  void readJoy(const YamlField& field) {
    const std::vector<YamlField> entries = source_.map(field, {"axes", "buttons"});
    const auto read = [&](const char* key, int type, std::vector<int>& codes) {
      const YamlField* list = find(entries, key);
      if (list == nullptr) return;
      codes.clear();
      for (const YamlField& item : source_.list(*list)) codes.push_back(named(item, type));
    };
    read("axes", EV_ABS, mapping_.joy.axes);
    read("buttons", EV_KEY, mapping_.joy.buttons);
  }

  /// A quantity within limits of the URDF, to kRounding; what is beyond by less becomes the limit.
  double within(const YamlField& field, const std::string& unit, double low, double high) const {
    constexpr double kAny = std::numeric_limits<double>::max();
    const double value = source_.quantity(field, unit, -kAny, kAny);
    const double spare = kRounding * (high - low);
    if (value < low - spare || value > high + spare) {
      source_.fail(field, "'" + field.value.Scalar() + "' is out of range; write a value from " + show(low, unit) +
                              " to " + show(high, unit));
    }
    return std::clamp(value, low, high);
  }

  int code(const YamlField& field, int type) {
    const int code = named(field, type);
    const auto [entry, is_new] = used_.emplace(std::make_pair(type, code), field.path);
    if (!is_new)
      source_.fail(field, source_.text(field) + " is used by " + entry->second + " already; use each control once");
    return code;
  }

  int named(const YamlField& field, int type) const {
    const std::string name = source_.text(field);
    const int code = eventCodeFromName(type, name);
    if (code >= 0) return code;
    const std::string kind = type == EV_ABS ? "an axis (vibe_gamepad shows the names)" : "a button";
    source_.fail(field, "'" + name + "' is not the name of " + kind + "; " + suggestKey(name, codeNames(type)));
  }

  void readPair(const YamlField& field, int type, JointMapping& joint) {
    const std::vector<YamlField> items = source_.list(field);
    if (items.size() != 2) source_.fail(field, "needs two names, the first moves the joint forwards; write [A, B]");
    joint.forward = code(items[0], type);
    joint.backward = code(items[1], type);
  }
};

JoyNames::JoyNames()
    : axes{ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ, ABS_HAT0X, ABS_HAT0Y}, buttons{BTN_SOUTH,  BTN_EAST,  BTN_NORTH,
                                                                                       BTN_WEST,   BTN_TL,    BTN_TR,
                                                                                       BTN_SELECT, BTN_START, BTN_MODE,
                                                                                       BTN_THUMBL, BTN_THUMBR} {}

ToolLimits loadToolLimits(const std::string& urdf_address) {
  const std::string file = resolveAddress(urdf_address);
  return ToolModel::fromUrdf(readTextFile(file, "URDF"), file).limits();
}

std::vector<std::string> unreachable(const PadMapping& mapping) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < kJointCount; ++j)
    if (mapping.joints[j].control == JointMapping::Control::None) names.emplace_back(kJointNames[j]);
  for (std::size_t b = 0; b < kButtonCount; ++b)
    if (mapping.buttons[b].code < 0) names.emplace_back(kButtonNames[b]);
  return names;
}

PadMapping loadPadMapping(const std::string& file, const ToolLimits& limits) {
  const YamlSource source = YamlSource::load(file, kLimits);
  return PadMappingReader(source, limits).read();
}

PadMapping parsePadMapping(const std::string& text, const std::string& place, const ToolLimits& limits) {
  const YamlSource source = YamlSource::parse(text, place, kLimits);
  return PadMappingReader(source, limits).read();
}

}  // namespace vibe::hardware
