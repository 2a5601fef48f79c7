// sources: src/config/*.cpp src/marker/*.cpp src/image/*.cpp ../vibe_core/src/scene/yaml_source.cpp
// sources: ../vibe_core/src/scene/yaml_guard.cpp ../vibe_core/src/scene/unit.cpp ../vibe_core/src/scene/words.cpp
// sources: ../vibe_core/src/files/files.cpp ../vibe_core/src/files/foreign_content.cpp
// sources: ../vibe_core/src/files/number_text.cpp
// includes: ../vibe_core/src
// packages: yaml-cpp eigen3
#include <cmath>
#include <cstdlib>
#include <string>

#include "vibe_core/program/error.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vision = vibe::vision;

// Any text as the configuration of a rig: an Error with its sentence, or a configuration that is written and read back
// to the same text and has no number that is not finite.

namespace {

// Text that is often nearly right: the input replaces a part of it.
const char* const kRig = R"(camera:
  size: [728, 544]
  focal_length: [4600 px, 4600 px]
  centre: [361.4 px, 274.2 px]
  distortion: [0.1, 0, 0, 0, 0]
  noise: {gain: 0.1 DN, read: 0.6 DN}
  blur: 0.6 px
gates: {min_contrast: 20 DN, min_visible: 40 %, max_scale_error: 15 %, max_tilt: 20 deg}
instruments:
  - name: helix
    marker:
      sleeve: {diameter: 3 mm, length: 10 mm}
    axis: {origin: [363 px, 120 px], direction: [1, 0.1], scale: 10 px/mm, perspective: 0.02 1/m}
    range: [-27 mm, 27 mm]
    motion: {max_speed: 0.8 m/s}
    slide_joint: {name: helix_advance, sign: 1, offset: 0 mm}
    rotation_joint: {name: helix_rotation}
  - name: needle_driver
    marker: {ring: {outer_diameter: 4 mm}}
    axis: {origin: [363 px, 240 px], direction: [1, 0], scale: 10 px/mm}
    range: [-25 mm, 25 mm]
    slide_joint: {name: needle_driver}
)";

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const vision::VisionConfig& config) {
  require(!config.instruments.empty() && config.instruments.size() <= 8);
  require(config.camera.width > 0 && config.camera.fx > 0);
  for (const vision::InstrumentConfig& instrument : config.instruments) {
    require(instrument.lower < instrument.upper);
    const double along = vision::alongOf(instrument.axis, instrument.upper);
    require(!instrument.axis.isCalibrated() || std::isfinite(along));
    require(std::abs(instrument.axis.direction.norm() - 1) < 1e-8);
  }
}

void parse(const std::string& text, vision::AxisRule rule) {
  std::string written;
  try {
    const vision::VisionConfig config = vision::VisionConfig::parse(text, "fuzz.yaml", rule);
    check(config);
    written = vision::toYaml(config);
  } catch (const vibe::Error& error) {
    require(error.what()[0] != '\0');
    return;
  }
  require(vision::toYaml(vision::VisionConfig::parse(written, "written.yaml", rule)) == written);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  parse(text, vision::AxisRule::Optional);
  if (size < 3) return 0;
  std::string rig = kRig;
  const std::size_t at = (static_cast<std::size_t>(data[0]) << 8 | data[1]) % rig.size();
  const std::size_t length = std::min<std::size_t>(data[2] & 31, rig.size() - at);
  parse(rig.replace(at, length, text.substr(3)), vision::AxisRule::Required);
  return 0;
}
