#include "vibe_vision/config/vision_config.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "config/config_reader.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::vision {

double alongOf(const SlideAxis& axis, double slide) {
  return axis.pixels_per_metre * slide / (1 + axis.perspective * slide);
}

double slideOf(const SlideAxis& axis, double along) {
  return along / (axis.pixels_per_metre - axis.perspective * along);
}

double pixelsPerMetre(const SlideAxis& axis, double slide) {
  const double w = 1 + axis.perspective * slide;
  return axis.pixels_per_metre / (w * w);
}

VisionConfig VisionConfig::load(const std::string& address, AxisRule rule) {
  return ConfigReader(YamlSource::load(resolveAddress(address), {}), rule).read();
}

VisionConfig VisionConfig::parse(const std::string& yaml, const std::string& place, AxisRule rule) {
  return ConfigReader(YamlSource::parse(yaml, place, {}), rule).read();
}

std::size_t VisionConfig::indexOf(const std::string& instrument) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    if (instruments[i].name == instrument) return i;
    names.push_back(instruments[i].name);
  }
  throw Error("'" + instrument + "' is not an instrument of this configuration; " + suggestKey(instrument, names));
}

namespace {

/// A text that YAML reads as it is: a string of JSON.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string pair(double a, double b, const std::string& unit) {
  return "[" + showQuantity(a, unit) + ", " + showQuantity(b, unit) + "]";
}

std::string number(double value) {
  return showQuantity(value, "1");
}

void writeCamera(const VisionConfig& config, std::ostream& out) {
  const CameraModel& camera = config.camera;
  out << "camera:\n";
  out << "  size: [" << camera.width << ", " << camera.height << "]\n";
  out << "  focal_length: " << pair(camera.fx, camera.fy, "px") << "\n";
  out << "  centre: " << pair(camera.cx, camera.cy, "px") << "\n";
  out << "  distortion: [";
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) out << (i > 0 ? ", " : "") << number(camera.distortion[i]);
  out << "]  # k1, k2, p1, p2, k3\n";
  out << "  reprojection_rms: " << showQuantity(camera.reprojection_rms, "px") << "\n";
  out << "  noise: {gain: " << showQuantity(config.noise.gain, "DN")
      << ", read: " << showQuantity(config.noise.read, "DN") << "}\n";
  out << "  blur: " << showQuantity(config.blur, "px") << "\n";
  if (config.gamma) out << "  gamma: " << number(*config.gamma) << "\n";
}

void writeGates(const GateConfig& gates, std::ostream& out) {
  out << "gates:\n";
  out << "  min_contrast: " << showQuantity(gates.min_contrast, "DN") << "\n";
  out << "  min_visible: " << number(gates.min_visible) << "\n";
  out << "  max_scale_error: " << number(gates.max_scale_error) << "\n";
  out << "  max_tilt: " << showQuantity(gates.max_tilt, "rad") << "\n";
}

void writeMarker(const RingDesign& ring, std::ostream& out) {
  out << "      ring: {outer_diameter: " << showQuantity(ring.outer_diameter, "m")
      << ", inner_diameter: " << showQuantity(ring.inner_diameter, "m") << ", side: " << showQuantity(ring.side, "m")
      << "}\n";
}

void writeMarker(const TagDesign& tag, std::ostream& out) {
  out << "      " << tagFamilyName(tag.family) << ": {id: " << tag.id << ", side: " << showQuantity(tag.side, "m")
      << "}\n";
}

void writeMarker(const SleeveDesign& sleeve, std::ostream& out) {
  out << "      sleeve:\n";
  out << "        diameter: " << showQuantity(sleeve.diameter, "m") << "\n";
  out << "        length: " << showQuantity(sleeve.length, "m") << "\n";
  out << "        bars:" << (sleeve.bars.empty() ? " []\n" : "\n");
  for (const Bar& bar : sleeve.bars) out << "          - " << pair(bar.begin, bar.end, "m") << "\n";
  out << "        helix: {begin: " << showQuantity(sleeve.helix_begin, "m")
      << ", end: " << showQuantity(sleeve.helix_end, "m") << ", pitch: " << showQuantity(sleeve.helix_pitch, "m")
      << ", duty: " << number(sleeve.helix_duty) << "}\n";
}

void writeAxis(const SlideAxis& axis, std::ostream& out) {
  out << "    axis:\n";
  out << "      origin: " << pair(axis.origin.x(), axis.origin.y(), "px") << "\n";
  out << "      direction: [" << number(axis.direction.x()) << ", " << number(axis.direction.y()) << "]\n";
  out << "      scale: " << showQuantity(axis.pixels_per_metre, "px/m") << "\n";
  out << "      perspective: " << showQuantity(axis.perspective, "1/m") << "\n";
  out << "      residual_rms: " << showQuantity(axis.residual_rms, "m") << "\n";
  if (axis.covariance.isZero(0)) return;
  out << "      # of origin along and across [px], angle [rad], scale [px/m], perspective [1/m]: upper triangle\n";
  out << "      covariance: [";
  for (int row = 0; row < 5; ++row) {
    for (int column = row; column < 5; ++column)
      out << (row + column > 0 ? ", " : "") << number(axis.covariance(row, column));
  }
  out << "]\n";
}

void writeJoint(const char* key, const std::string& name, double sign, double offset, const char* unit,
                std::ostream& out) {
  out << "    " << key << ": {name: " << quoted(name) << ", sign: " << (sign < 0 ? "-1" : "1")
      << ", offset: " << showQuantity(offset, unit) << "}\n";
}

void writeInstrument(const InstrumentConfig& instrument, std::ostream& out) {
  out << "  - name: " << quoted(instrument.name) << "\n";
  out << "    marker:\n";
  std::visit([&out](const auto& design) { writeMarker(design, out); }, instrument.marker);
  if (instrument.ink != 0) out << "    ink: " << showQuantity(instrument.ink, "m") << "\n";
  if (instrument.axis.isCalibrated()) writeAxis(instrument.axis, out);
  out << "    range: " << pair(instrument.lower, instrument.upper, "m") << "\n";
  out << "    lateral_tolerance: " << showQuantity(instrument.lateral_tolerance, "m") << "\n";
  out << "    motion: {max_speed: " << showQuantity(instrument.motion.max_speed, "m/s")
      << ", max_acceleration: " << showQuantity(instrument.motion.max_acceleration, "m/s^2")
      << ", max_angular_speed: " << showQuantity(instrument.motion.max_angular_speed, "rad/s") << "}\n";
  writeJoint("slide_joint", instrument.slide_joint, instrument.slide_sign, instrument.slide_offset, "m", out);
  if (instrument.rotation_joint.empty()) return;
  writeJoint("rotation_joint", instrument.rotation_joint, instrument.rotation_sign, instrument.rotation_offset, "rad",
             out);
}

}  // namespace

std::string toYaml(const VisionConfig& config) {
  std::ostringstream out;
  out << "# What the camera sees of the instruments. Format: docs/vision.md, \"Configuration\".\n\n";
  writeCamera(config, out);
  out << "\n";
  writeGates(config.gates, out);
  out << "\ninstruments:\n";
  for (const InstrumentConfig& instrument : config.instruments) writeInstrument(instrument, out);
  return out.str();
}

}  // namespace vibe::vision
