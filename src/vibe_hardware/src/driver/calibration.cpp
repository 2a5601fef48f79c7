#include "vibe_hardware/driver/calibration.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "vibe_core/files/files.hpp"
#include "vibe_core/input/joint_unit.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::hardware {
namespace {

const std::vector<std::string> kDeviceNames{"haptic", "input"};
constexpr double kMinScale = 1e-6, kMaxScale = 1e3;

const char* scaleUnitOf(int joint) {
  return isPrismatic(joint) ? "m/rad" : "1";
}
/// Far beyond any device: rejects errors of units.
double largestPosition(int joint) {
  return isPrismatic(joint) ? 2.0 : 100.0;
}

template <class Names>
int indexOf(const Names& names, const std::string& word) {
  const auto found = std::find(names.begin(), names.end(), word);
  return static_cast<int>(found - names.begin());
}

std::vector<std::string> jointNames(int from, int to) {
  return {kJointNames.begin() + from, kJointNames.begin() + to};
}

/// "1209:0001" as lsusb shows it. @return false if it is not that
bool parseId(const std::string& text, DeviceSelection& selection) {
  if (text.size() != 9 || text[4] != ':') return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i != 4 && std::isxdigit(static_cast<unsigned char>(text[i])) == 0) return false;
  }
  selection.vendor = static_cast<std::uint16_t>(std::stoul(text.substr(0, 4), nullptr, 16));
  selection.product = static_cast<std::uint16_t>(std::stoul(text.substr(5), nullptr, 16));
  return true;
}

}  // namespace

/// Reads a Calibration from YAML. Every mistake ends in an Error "file:line: key: what is wrong; remedy".
class CalibrationReader {
 public:
  explicit CalibrationReader(YamlSource source) : source_(std::move(source)) {}

  Calibration read() {
    const std::vector<YamlField> fields = source_.map(
        source_.root(), {"devices", "joints", "homing", "buttons", "suturing_device"}, {"devices", "joints"});
    // homing needs the joints, wherever they stand in the file
    for (const YamlField& field : fields) {
      if (field.key == "devices") readDevices(field);
      if (field.key == "joints") readJoints(field);
      if (field.key == "buttons") readButtons(field);
      if (field.key == "suturing_device") readSuturingDevice(field);
    }
    for (const YamlField& field : fields) {
      if (field.key == "homing") readHoming(field);
    }
    return calibration_;
  }

 private:
  YamlSource source_;
  Calibration calibration_;

  void readDevices(const YamlField& field) {
    for (const YamlField& entry : source_.map(field, kDeviceNames, kDeviceNames)) {
      calibration_.devices[static_cast<std::size_t>(indexOf(kDeviceNames, entry.key))] = readDevice(entry);
    }
  }

  DeviceSelection readDevice(const YamlField& field) const {
    DeviceSelection selection;
    for (const YamlField& entry : source_.map(field, {"id", "serial"}, {"id"})) {
      const std::string text = source_.text(entry);
      if (entry.key == "serial") selection.serial = text;
      if (entry.key == "id" && !parseId(text, selection)) {
        source_.fail(entry, "'" + text.substr(0, 40) +
                                "' is not a USB id; write vendor and product as lsusb shows them, such as 1209:0001");
      }
    }
    return selection;
  }

  void readJoints(const YamlField& field) {
    const std::vector<std::string> names = jointNames(0, kScopeJointCount);
    for (const YamlField& entry : source_.map(field, names, names)) {
      const int joint = indexOf(names, entry.key);
      calibration_.joints[static_cast<std::size_t>(joint)] = readJoint(entry, joint);
    }
    checkAxesOnce(field);
  }

  JointCalibration readJoint(const YamlField& field, int joint) const {
    JointCalibration result;
    double direction = 1;
    const std::vector<std::string> keys{"device", "axis", "scale", "direction", "offset", "limits"};
    for (const YamlField& entry : source_.map(field, keys, {"device", "axis", "scale", "limits"})) {
      if (entry.key == "device")
        result.device = static_cast<DeviceKind>(indexOf(kDeviceNames, source_.choice(entry, kDeviceNames)));
      if (entry.key == "axis") result.axis = static_cast<int>(source_.integer(entry, 0, vibe_firmware::kAxisCount - 1));
      if (entry.key == "scale") result.scale.scale = source_.quantity(entry, scaleUnitOf(joint), kMinScale, kMaxScale);
      if (entry.key == "direction") direction = source_.choice(entry, {"1", "-1"}) == "1" ? 1 : -1;
      if (entry.key == "offset") {
        result.scale.offset =
            source_.quantity(entry, jointUnit(joint), -largestPosition(joint), largestPosition(joint));
      }
      if (entry.key == "limits") readLimits(entry, joint, result.lower, result.upper);
    }
    result.scale.scale *= direction;
    return result;
  }

  void readLimits(const YamlField& field, int joint, double& lower, double& upper) const {
    const double largest = largestPosition(joint);
    const std::vector<double> limits = source_.quantities(field, 2, jointUnit(joint), -largest, largest);
    if (limits[0] >= limits[1]) source_.fail(field, "does not have its lower end first; write [lower, upper]");
    lower = limits[0];
    upper = limits[1];
  }

  void readHoming(const YamlField& field) {
    for (const YamlField& entry : source_.map(field, {"button", "positions"}, {"button", "positions"})) {
      if (entry.key == "button") calibration_.homing = readButton(entry);
      if (entry.key != "positions") continue;
      const std::vector<std::string> names = jointNames(0, kScopeJointCount);
      for (const YamlField& position : source_.map(entry, names)) {
        const int joint = indexOf(names, position.key);
        const double largest = largestPosition(joint);
        const double home = source_.quantity(position, jointUnit(joint), -largest, largest);
        checkHome(position, joint, home);
        calibration_.joints[static_cast<std::size_t>(joint)].home = home;
      }
    }
  }

  void readButtons(const YamlField& field) {
    const std::vector<std::string> names(kButtonNames.begin(), kButtonNames.end());
    for (const YamlField& entry : source_.map(field, names)) {
      calibration_.buttons[static_cast<std::size_t>(indexOf(names, entry.key))] = readButton(entry);
    }
  }

  DeviceButton readButton(const YamlField& field) const {
    DeviceButton button;
    for (const YamlField& entry : source_.map(field, {"device", "bit"}, {"device", "bit"})) {
      if (entry.key == "device")
        button.device = static_cast<DeviceKind>(indexOf(kDeviceNames, source_.choice(entry, kDeviceNames)));
      if (entry.key == "bit") button.bit = static_cast<int>(source_.integer(entry, 0, kDeviceButtons - 1));
    }
    return button;
  }

  void readSuturingDevice(const YamlField& field) {
    const std::vector<std::string> names = jointNames(kScopeJointCount, kJointCount);
    calibration_.suturing_device.emplace();
    for (const YamlField& entry : source_.map(field, names, names)) {
      const int index = indexOf(names, entry.key);
      (*calibration_.suturing_device)[static_cast<std::size_t>(index)] = readDrive(entry, kScopeJointCount + index);
    }
  }

  ButtonDrive readDrive(const YamlField& field, int joint) const {
    ButtonDrive drive;
    const std::vector<std::string> keys{"forward", "backward", "speed", "limits"};
    for (const YamlField& entry : source_.map(field, keys, keys)) {
      if (entry.key == "forward") drive.forward = readButton(entry);
      if (entry.key == "backward") drive.backward = readButton(entry);
      if (entry.key == "speed")
        drive.speed = source_.quantity(entry, jointSpeedUnit(joint), 1e-6, largestPosition(joint));
      if (entry.key == "limits") readLimits(entry, joint, drive.lower, drive.upper);
    }
    if (drive.lower > 0 || drive.upper < 0) {
      source_.fail(field, "has limits without 0, where the joint begins; write limits on both sides of 0 or at it");
    }
    return drive;
  }

  void checkAxesOnce(const YamlField& field) const {
    for (std::size_t a = 0; a < calibration_.joints.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const JointCalibration &one = calibration_.joints[a], &other = calibration_.joints[b];
        if (one.device != other.device || one.axis != other.axis) continue;
        source_.fail(field, std::string(kJointNames[b]) + " and " + kJointNames[a] + " are both measured by axis " +
                                std::to_string(one.axis) + " of the " + deviceName(one.device) +
                                "; give each joint an axis of its own");
      }
    }
  }

  void checkHome(const YamlField& field, int joint, double home) const {
    const JointCalibration& calibration = calibration_.joints[static_cast<std::size_t>(joint)];
    if (home >= calibration.lower && home <= calibration.upper) return;
    source_.fail(field, "is outside the limits of the joint, " + showQuantity(calibration.lower, jointUnit(joint)) +
                            " to " + showQuantity(calibration.upper, jointUnit(joint)) +
                            "; write a position between them");
  }
};

Calibration Calibration::parse(const std::string& yaml, const std::string& place) {
  return CalibrationReader(YamlSource::parse(yaml, place, {})).read();
}

Calibration Calibration::load(const std::string& address) {
  return CalibrationReader(YamlSource::load(resolveAddress(address), {})).read();
}

bool Calibration::uses(DeviceKind device) const {
  return std::any_of(joints.begin(), joints.end(), [device](const auto& joint) { return joint.device == device; });
}

int Calibration::jointOf(DeviceKind device, int axis) const {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].device == device && joints[j].axis == axis) return static_cast<int>(j);
  }
  return -1;
}

}  // namespace vibe::hardware
