#include "config/config_reader.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe::vision {
namespace {

// Far beyond any rig: these ranges reject errors of units.
constexpr int kSmallestImage = 16, kLargestImage = 16384;
constexpr double kMaxFocalLength = 1e6;                    // [px]
constexpr double kShortestLens = 0.1, kLongestLens = 200;  // of the longer side of the image: 157 and 0.3 deg wide
constexpr double kMaxPixel = 1e5;                          // [px]
constexpr double kMaxDistortion = 1e4;                     // k1 of a lens of 1 m is that large
constexpr double kMaxResidual = 100;                       // [px]
constexpr double kMaxLength = 1;                           // [m]
constexpr double kMaxLateral = 0.05;                       // [m]
constexpr double kMaxInk = 2e-4;                           // [m]
constexpr double kMaxAngle = 100;                          // [rad]
constexpr std::size_t kMaxNamed = 8;                       // instruments, as many as fit into a datagram
constexpr double kUnitTolerance = 1e-9;                    // a direction closer to length 1 is kept as it is
constexpr double kSmallestDirection = 1e-3;

}  // namespace

std::vector<YamlField> ConfigReader::mapOf(const YamlField& field, const Keys& keys, const Keys& required) const {
  std::vector<YamlField> fields = source_.map(field);
  for (const YamlField& entry : fields) {
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end()) {
      source_.fail(entry, "is not a known key; " + suggestKey(entry.key, keys));
    }
  }
  for (const std::string& key : required) {
    const auto is_it = [&key](const YamlField& entry) { return entry.key == key; };
    if (std::none_of(fields.begin(), fields.end(), is_it)) {
      source_.fail(field, "lacks the key '" + key + "'; add it below");
    }
  }
  return fields;
}

VisionConfig ConfigReader::read() {
  const std::vector<YamlField> fields =
      mapOf(source_.root(), {"camera", "gates", "instruments"}, {"camera", "instruments"});
  // the checks of axes need the camera, wherever it stands in the file
  for (const YamlField& field : fields) {
    if (field.key == "camera") readCamera(field);
    if (field.key == "gates") readGates(field);
  }
  for (const YamlField& field : fields) {
    if (field.key == "instruments") readInstruments(field);
  }
  return config_;
}

void ConfigReader::readCamera(const YamlField& field) {
  CameraModel& camera = config_.camera;
  const Keys keys{"size", "focal_length", "centre", "distortion", "reprojection_rms", "noise", "blur", "gamma"};
  for (const YamlField& entry : mapOf(field, keys, {"size", "focal_length", "centre"})) {
    if (entry.key == "size") readSize(entry);
    if (entry.key == "focal_length") {
      const std::vector<double> focal = source_.quantities(entry, 2, "px", 1, kMaxFocalLength);
      camera.fx = focal[0];
      camera.fy = focal[1];
    }
    if (entry.key == "centre") {
      const std::vector<double> centre = source_.quantities(entry, 2, "px", -kMaxPixel, kMaxPixel);
      camera.cx = centre[0];
      camera.cy = centre[1];
    }
    if (entry.key == "distortion") {
      const std::vector<double> values = source_.quantities(entry, 5, "1", -kMaxDistortion, kMaxDistortion);
      std::copy(values.begin(), values.end(), camera.distortion.begin());
    }
    if (entry.key == "reprojection_rms") camera.reprojection_rms = source_.quantity(entry, "px", 0, kMaxResidual);
    if (entry.key == "noise") readNoise(entry);
    if (entry.key == "blur") config_.blur = source_.quantity(entry, "px", 0.1, 20);
    if (entry.key == "gamma") config_.gamma = source_.quantity(entry, "1", 0.5, 3);
  }
  checkLens(field);
}

void ConfigReader::readSize(const YamlField& field) {
  const std::vector<YamlField> items = source_.list(field);
  if (items.size() != 2) {
    source_.fail(field,
                 "has " + std::to_string(items.size()) + " values; write width and height in pixels, [728, 544]");
  }
  config_.camera.width = static_cast<int>(source_.integer(items[0], kSmallestImage, kLargestImage));
  config_.camera.height = static_cast<int>(source_.integer(items[1], kSmallestImage, kLargestImage));
}

void ConfigReader::readNoise(const YamlField& field) {
  for (const YamlField& entry : mapOf(field, {"gain", "read"}, {})) {
    if (entry.key == "gain") config_.noise.gain = source_.quantity(entry, "DN", 0, 100);
    if (entry.key == "read") config_.noise.read = source_.quantity(entry, "DN", 0.01, 100);
  }
}

void ConfigReader::readGates(const YamlField& field) {
  GateConfig& gates = config_.gates;
  for (const YamlField& entry : mapOf(field, {"min_contrast", "min_visible", "max_scale_error", "max_tilt"}, {})) {
    if (entry.key == "min_contrast") gates.min_contrast = source_.quantity(entry, "DN", 1, 255);
    if (entry.key == "min_visible") gates.min_visible = source_.quantity(entry, "1", 0.05, 1);
    if (entry.key == "max_scale_error") gates.max_scale_error = source_.quantity(entry, "1", 0.001, 0.5);
    if (entry.key == "max_tilt") gates.max_tilt = source_.quantity(entry, "rad", 0.001, 0.785);
  }
}

void ConfigReader::readInstruments(const YamlField& field) {
  const std::vector<YamlField> items = source_.list(field);
  if (items.empty() || items.size() > kMaxNamed) {
    source_.fail(field, "has " + std::to_string(items.size()) + " instruments; describe 1 to " +
                            std::to_string(kMaxNamed) + " of them in lines that begin with '- name: ...'");
  }
  for (const YamlField& item : items) {
    const InstrumentConfig instrument = readInstrument(item);
    checkUnique(item, instrument);
    config_.instruments.push_back(instrument);
  }
}

InstrumentConfig ConfigReader::readInstrument(const YamlField& field) const {
  InstrumentConfig instrument;
  const Keys keys{"name",   "marker",      "ink",           "axis", "range", "lateral_tolerance",
                  "motion", "slide_joint", "rotation_joint"};
  Keys required{"name", "marker", "range", "slide_joint"};
  if (rule_ == AxisRule::Required) required.emplace_back("axis");
  const std::vector<YamlField> fields = mapOf(field, keys, required);
  for (const YamlField& entry : fields) {
    if (entry.key == "name") instrument.name = source_.text(entry);
    if (entry.key == "marker") instrument.marker = readMarker(entry);
    if (entry.key == "ink") instrument.ink = source_.quantity(entry, "m", -kMaxInk, kMaxInk);
    if (entry.key == "axis") instrument.axis = readAxis(entry);
    if (entry.key == "range") readRange(entry, instrument);
    if (entry.key == "lateral_tolerance")
      instrument.lateral_tolerance = source_.quantity(entry, "m", 1e-6, kMaxLateral);
    if (entry.key == "motion") instrument.motion = readMotion(entry);
    if (entry.key == "slide_joint")
      readJoint(entry, "m", instrument.slide_joint, instrument.slide_sign, instrument.slide_offset);
    if (entry.key == "rotation_joint")
      readJoint(entry, "rad", instrument.rotation_joint, instrument.rotation_sign, instrument.rotation_offset);
  }
  for (const YamlField& entry : fields) {
    if (entry.key == "rotation_joint" && !std::holds_alternative<SleeveDesign>(instrument.marker))
      source_.fail(entry, "needs a sleeve, " +
                              std::string(std::holds_alternative<RingDesign>(instrument.marker)
                                              ? "a ring does not show the rotation"
                                              : "a flat tag does not show the rotation of a rod") +
                              "; leave the key out or use a sleeve");
    if (entry.key == "axis") checkAxis(entry, instrument);
  }
  return instrument;
}

MotionLimits ConfigReader::readMotion(const YamlField& field) const {
  MotionLimits motion;
  for (const YamlField& entry : mapOf(field, {"max_speed", "max_acceleration", "max_angular_speed"}, {})) {
    if (entry.key == "max_speed") motion.max_speed = source_.quantity(entry, "m/s", 1e-4, 100);
    if (entry.key == "max_acceleration") motion.max_acceleration = source_.quantity(entry, "m/s^2", 1e-3, 1e4);
    if (entry.key == "max_angular_speed") motion.max_angular_speed = source_.quantity(entry, "rad/s", 1e-3, 1e4);
  }
  return motion;
}

void ConfigReader::readRange(const YamlField& field, InstrumentConfig& instrument) const {
  const std::vector<double> range = source_.quantities(field, 2, "m", -kMaxLength, kMaxLength);
  if (range[0] >= range[1]) source_.fail(field, "does not have its lower end first; write [lower, upper]");
  instrument.lower = range[0];
  instrument.upper = range[1];
}

void ConfigReader::readJoint(const YamlField& field, const std::string& unit, std::string& name, double& sign,
                             double& offset) const {
  const double largest = unit == "m" ? kMaxLength : kMaxAngle;
  for (const YamlField& entry : mapOf(field, {"name", "sign", "offset"}, {"name"})) {
    if (entry.key == "name") name = source_.text(entry);
    if (entry.key == "sign") sign = source_.choice(entry, {"1", "-1"}) == "1" ? 1 : -1;
    if (entry.key == "offset") offset = source_.quantity(entry, unit, -largest, largest);
  }
}

SlideAxis ConfigReader::readAxis(const YamlField& field) const {
  SlideAxis axis;
  const Keys keys{"origin", "direction", "scale", "perspective", "residual_rms", "covariance"};
  for (const YamlField& entry : mapOf(field, keys, {"origin", "direction", "scale"})) {
    if (entry.key == "origin") {
      const std::vector<double> origin = source_.quantities(entry, 2, "px", -kMaxPixel, kMaxPixel);
      axis.origin = {origin[0], origin[1]};
    }
    if (entry.key == "direction") axis.direction = readDirection(entry);
    if (entry.key == "scale") axis.pixels_per_metre = source_.quantity(entry, "px/m", 100, 1e6);
    if (entry.key == "perspective") axis.perspective = source_.quantity(entry, "1/m", -1e3, 1e3);
    if (entry.key == "residual_rms") axis.residual_rms = source_.quantity(entry, "m", 0, kMaxLength);
    if (entry.key == "covariance") readCovariance(entry, axis);
  }
  return axis;
}

Eigen::Vector2d ConfigReader::readDirection(const YamlField& field) const {
  const std::vector<double> values = source_.quantities(field, 2, "1", -1e6, 1e6);
  const Eigen::Vector2d direction(values[0], values[1]);
  const double length = direction.norm();
  if (length < kSmallestDirection) {
    source_.fail(field, "has no direction; write x to the right and y down, for example [1, 0]");
  }
  return std::abs(length - 1) < kUnitTolerance ? direction : direction / length;
}

void ConfigReader::readCovariance(const YamlField& field, SlideAxis& axis) const {
  const std::vector<double> values = source_.quantities(field, 15, "1", -1e12, 1e12);
  std::size_t next = 0;
  for (int row = 0; row < 5; ++row) {
    for (int column = row; column < 5; ++column) {
      axis.covariance(row, column) = axis.covariance(column, row) = values[next++];
    }
    if (axis.covariance(row, row) < 0) {
      source_.fail(field, "has a negative variance; copy the list as vibe_calibrate wrote it, or leave the key out");
    }
  }
}

void ConfigReader::checkUnique(const YamlField& field, const InstrumentConfig& instrument) const {
  Keys joints{instrument.slide_joint, instrument.rotation_joint};
  for (const InstrumentConfig& other : config_.instruments) {
    if (other.name == instrument.name) {
      source_.fail(field, "has the name '" + other.name + "' a second time; give each instrument a name of its own");
    }
    joints.insert(joints.end(), {other.slide_joint, other.rotation_joint});
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (joints[i].empty() || std::count(joints.begin(), joints.end(), joints[i]) == 1) continue;
    source_.fail(field, "moves the joint '" + joints[i] + "', which is already moved; give each joint one measurement");
  }
}

void ConfigReader::checkAxis(const YamlField& field, const InstrumentConfig& instrument) const {
  constexpr double kNearest = 0.1;  // of the distance from the camera at slide 0
  bool seen = false;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double slide = instrument.lower + share * (instrument.upper - instrument.lower);
    if (1 + instrument.axis.perspective * slide < kNearest) {
      source_.fail(field, "has a perspective with which the slide " + showQuantity(slide, "m") +
                              " would be behind the camera; correct 'perspective' or calibrate the axis again");
    }
    const Eigen::Vector2d point = instrument.axis.origin + instrument.axis.direction * alongOf(instrument.axis, slide);
    const double margin = 0.25 * std::max(config_.camera.width, config_.camera.height);  // for the distortion
    seen = seen || (point.x() > -margin && point.x() < config_.camera.width + margin && point.y() > -margin &&
                    point.y() < config_.camera.height + margin);
  }
  if (seen) return;
  source_.fail(field, "lies outside of the image of " + std::to_string(config_.camera.width) + " x " +
                          std::to_string(config_.camera.height) +
                          " px over the whole range; correct camera.size or calibrate the axis again");
}

void ConfigReader::checkLens(const YamlField& field) const {
  const CameraModel& camera = config_.camera;
  const double width = std::max(camera.width, camera.height);
  for (const double focal : {camera.fx, camera.fy})
    if (focal < kShortestLens * width || focal > kLongestLens * width)
      source_.fail(field, "has a focal length of " + showQuantity(focal, "px") + " for an image of " +
                              std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                              " px, which no lens has; write it in pixels: millimetres over the size of a pixel");
  for (const double x : {0.0, 0.5 * (camera.width - 1), camera.width - 1.0}) {
    for (const double y : {0.0, 0.5 * (camera.height - 1), camera.height - 1.0}) {
      if (undistort(camera, {x, y}).allFinite()) continue;
      source_.fail(field, "has a distortion that folds the image over near pixel " + showQuantity(x, "1") + ", " +
                              showQuantity(y, "1") +
                              "; calibrate the lens with the board in all corners: vibe_calibrate intrinsics");
    }
  }
}

}  // namespace vibe::vision
