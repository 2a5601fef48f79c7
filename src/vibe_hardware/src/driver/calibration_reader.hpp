#pragma once
#include <string>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_hardware/driver/calibration.hpp"

namespace vibe::hardware {

/// Reads a Calibration from YAML. Every mistake ends in an Error "file:line: key: what is wrong; remedy".
class CalibrationReader {
 public:
  explicit CalibrationReader(YamlSource source) : source_(std::move(source)) {}
  Calibration read();

 private:
  YamlSource source_;
  Calibration calibration_;

  /// Fields of a map of which each key must be one of `keys` and each of the `required` must be there.
  std::vector<YamlField> mapOf(const YamlField& field, const std::vector<std::string>& keys,
                               const std::vector<std::string>& required) const;
  void readDevices(const YamlField& field);
  DeviceSelection readDevice(const YamlField& field) const;
  void readJoints(const YamlField& field);
  JointCalibration readJoint(const YamlField& field, int joint) const;
  void readLimits(const YamlField& field, int joint, double& lower, double& upper) const;
  void readHoming(const YamlField& field);
  void readButtons(const YamlField& field);
  DeviceButton readButton(const YamlField& field) const;
  void readOverstitch(const YamlField& field);
  ButtonDrive readDrive(const YamlField& field, int joint) const;
  void checkAxesOnce(const YamlField& field) const;
  void checkHome(const YamlField& field, int joint, double home) const;
};

}  // namespace vibe::hardware
