#include "vibe_hardware/driver/calibration.hpp"

#include <algorithm>

#include "driver/calibration_reader.hpp"
#include "vibe_core/common/package_path.hpp"

namespace vibe::hardware {

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
