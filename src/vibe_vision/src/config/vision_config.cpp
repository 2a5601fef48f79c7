#include "vibe_vision/config/vision_config.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/config_keys.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"

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

Eigen::Vector2d acrossOf(const SlideAxis& axis) {
  return {-axis.direction.y(), axis.direction.x()};
}

Eigen::Vector2d pixelAt(const SlideAxis& axis, double along, double lateral) {
  return axis.origin + along * axis.direction + lateral * acrossOf(axis);
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
constexpr double kSmallest = 1e-5, kLargest = 0.2;  // of anything printed [m]

void checkLens(const YamlSource& source, const YamlField& field, const CameraModel& camera) {
  const double width = std::max(camera.width, camera.height);
  for (const double focal : {camera.fx, camera.fy})
    if (focal < kShortestLens * width || focal > kLongestLens * width)
      source.fail(field, "has a focal length of " + showQuantity(focal, "px") + " for an image of " +
                             sizeText(camera.width, camera.height) +
                             " px, which no lens has; write it in pixels: millimetres over the size of a pixel");
  for (const double x : {0.0, 0.5 * (camera.width - 1), camera.width - 1.0}) {
    for (const double y : {0.0, 0.5 * (camera.height - 1), camera.height - 1.0}) {
      if (undistort(camera, {x, y}).allFinite()) continue;
      source.fail(field, "has a distortion that folds the image over near pixel " + showQuantity(x, "1") + ", " +
                             showQuantity(y, "1") +
                             "; calibrate the lens with the board in all corners: vibe_calibrate intrinsics");
    }
  }
}

ConfigKey sizeKey(CameraModel& camera) {
  const auto read = [&camera](const YamlSource& source, const YamlField& field) {
    const std::vector<YamlField> items = source.list(field);
    if (items.size() != 2)
      source.fail(field,
                  "has " + std::to_string(items.size()) + " values; write width and height in pixels, [728, 544]");
    camera.width = static_cast<int>(source.integer(items[0], kSmallestImage, kLargestImage));
    camera.height = static_cast<int>(source.integer(items[1], kSmallestImage, kLargestImage));
  };
  return {"size", read, "[" + std::to_string(camera.width) + ", " + std::to_string(camera.height) + "]"};
}

ConfigKeys cameraKeys(VisionConfig& config) {
  CameraModel& camera = config.camera;
  const auto read_distortion = [&camera](const YamlSource& source, const YamlField& field) {
    const std::vector<double> values = source.quantities(field, 5, "1", -kMaxDistortion, kMaxDistortion);
    std::copy(values.begin(), values.end(), camera.distortion.begin());
  };
  const auto read_gamma = [&config](const YamlSource& source, const YamlField& field) {
    config.gamma = source.quantity(field, "1", 0.5, 3);
  };
  return {required(sizeKey(camera)),
          required(pairKey("focal_length", camera.fx, camera.fy, "px", 1, kMaxFocalLength)),
          required(pairKey("centre", camera.cx, camera.cy, "px", -kMaxPixel, kMaxPixel)),
          {"distortion", read_distortion, listText(camera.distortion, "1") + "  # k1, k2, p1, p2, k3"},
          numberKey("reprojection_rms", camera.reprojection_rms, "px", 0, kMaxResidual),
          mapKey("noise", {numberKey("gain", config.noise.gain, "DN", 0, 100),
                           numberKey("read", config.noise.read, "DN", 0.01, 100)}),
          numberKey("blur", config.blur, "px", 0.1, 20),
          {"gamma", read_gamma, config.gamma ? showQuantity(*config.gamma, "1") : ""}};
}

ConfigKey gatesKey(GateConfig& gates) {
  return blockKey("gates",
                  {numberKey("min_contrast", gates.min_contrast, "DN", 1, 255),
                   numberKey("min_visible", gates.min_visible, "1", 0.05, 1),
                   numberKey("max_scale_error", gates.max_scale_error, "1", 0.001, 0.5),
                   numberKey("max_tilt", gates.max_tilt, "rad", 0.001, 0.785)},
                  "  ");
}

ConfigKey printedKey(const std::string& name, double& length, double low = kSmallest) {
  return numberKey(name, length, "m", low, kLargest);
}

ConfigKey markerKey(RingDesign& ring) {
  return mapKey("ring", {printedKey("outer_diameter", ring.outer_diameter),
                         printedKey("inner_diameter", ring.inner_diameter), printedKey("side", ring.side)});
}

ConfigKey markerKey(TagDesign& tag) {
  const auto read_id = [&tag](const YamlSource& source, const YamlField& field) {
    tag.id = static_cast<int>(source.integer(field, 0, tagCount(tag.family) - 1));
  };
  return mapKey(tagFamilyName(tag.family),
                {required({"id", read_id, std::to_string(tag.id)}), required(printedKey("side", tag.side))});
}

ConfigKey barsKey(std::vector<Bar>& bars) {
  const auto read = [&bars](const YamlSource& source, const YamlField& field) {
    constexpr std::size_t kMaxBars = 100;
    const std::vector<YamlField> items = source.list(field);
    if (items.size() > kMaxBars) source.fail(field, "has more than 100 bars; a camera cannot tell so many apart");
    bars.clear();
    for (const YamlField& item : items) {
      const std::vector<double> ends = source.quantities(item, 2, "m", -kLargest, kLargest);
      bars.push_back({ends[0], ends[1]});
    }
  };
  std::string text;
  for (const Bar& bar : bars) text += "\n          - " + listText(std::vector<double>{bar.begin, bar.end}, "m");
  return {"bars", read, text.empty() ? "[]" : text};
}

ConfigKey markerKey(SleeveDesign& sleeve) {
  const ConfigKey helix = mapKey(
      "helix",
      {printedKey("begin", sleeve.helix_begin, -kLargest), printedKey("end", sleeve.helix_end, -kLargest),
       printedKey("pitch", sleeve.helix_pitch, -kLargest), numberKey("duty", sleeve.helix_duty, "1", 0.01, 0.99)});
  return blockKey(
      "sleeve",
      {printedKey("diameter", sleeve.diameter), printedKey("length", sleeve.length), barsKey(sleeve.bars), helix},
      "        ");
}

void readMarker(const YamlSource& source, const YamlField& field, MarkerDesign& marker) {
  MarkerDesign designs[] = {RingDesign(), defaultSleeve(), TagDesign{TagFamily::AprilTag}, TagDesign{TagFamily::Aruco}};
  ConfigKeys keys;
  for (MarkerDesign& design : designs) keys.push_back(std::visit([](auto& one) { return markerKey(one); }, design));
  const std::vector<YamlField> fields = readMap(source, field, keys);
  if (fields.size() != 1) {
    source.fail(field, "names " + std::to_string(fields.size()) +
                           " markers; write one of 'ring:', 'sleeve:', 'apriltag:' and 'aruco:'");
  }
  const YamlField& entry = fields.front();
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].name == entry.key) marker = designs[i];
  checkMarker(marker, source.place() + ":" + std::to_string(entry.line) + ": " + entry.path);
}

/// The upper triangle, row by row.
ConfigKey covarianceKey(Eigen::Matrix<double, 5, 5>& covariance) {
  const auto read = [&covariance](const YamlSource& source, const YamlField& field) {
    const std::vector<double> values = source.quantities(field, 15, "1", -1e12, 1e12);
    std::size_t next = 0;
    for (int row = 0; row < 5; ++row) {
      for (int column = row; column < 5; ++column) covariance(row, column) = covariance(column, row) = values[next++];
      if (covariance(row, row) < 0)
        source.fail(field, "has a negative variance; copy the list as vibe_calibrate wrote it, or leave the key out");
    }
  };
  std::vector<double> values;
  for (int row = 0; row < 5; ++row)
    for (int column = row; column < 5; ++column) values.push_back(covariance(row, column));
  return {"covariance", read, covariance.isZero(0) ? "" : listText(values, "1"), false,
          "of origin along and across [px], angle [rad], scale [px/m], perspective [1/m]: upper triangle"};
}

ConfigKey directionKey(Eigen::Vector2d& direction) {
  const auto read = [&direction](const YamlSource& source, const YamlField& field) {
    const std::vector<double> values = source.quantities(field, 2, "1", -1e6, 1e6);
    direction = {values[0], values[1]};
    const double length = direction.norm();
    if (length < kSmallestDirection)
      source.fail(field, "has no direction; write x to the right and y down, for example [1, 0]");
    if (std::abs(length - 1) >= kUnitTolerance) direction /= length;
  };
  return {"direction", read, listText(direction, "1"), true};
}

ConfigKey axisKey(SlideAxis& axis, AxisRule rule) {
  const ConfigKeys keys = {required(pairKey("origin", axis.origin.x(), axis.origin.y(), "px", -kMaxPixel, kMaxPixel)),
                           directionKey(axis.direction),
                           required(numberKey("scale", axis.pixels_per_metre, "px/m", 100, 1e6)),
                           numberKey("perspective", axis.perspective, "1/m", -1e3, 1e3),
                           numberKey("residual_rms", axis.residual_rms, "m", 0, kMaxLength),
                           covarianceKey(axis.covariance)};
  ConfigKey key = blockKey("axis", keys, "      ");
  if (!axis.isCalibrated()) key.text.clear();
  key.required = rule == AxisRule::Required;
  return key;
}

ConfigKeys motionKeys(MotionLimits& motion) {
  return {numberKey("max_speed", motion.max_speed, "m/s", 1e-4, 100),
          numberKey("max_acceleration", motion.max_acceleration, "m/s^2", 1e-3, 1e4),
          numberKey("max_angular_speed", motion.max_angular_speed, "rad/s", 1e-3, 1e4)};
}

ConfigKey textKey(const std::string& name, std::string& value) {
  const auto read = [&value](const YamlSource& source, const YamlField& field) { value = source.text(field); };
  // a text that YAML reads as it is: a string of JSON
  return {name, read, nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), true};
}

/// @param unit  of the joint: "m" or "rad"
ConfigKey jointKey(const std::string& key, std::string& name, double& sign, double& offset, const std::string& unit) {
  const double largest = unit == "m" ? kMaxLength : kMaxAngle;
  const auto read_sign = [&sign](const YamlSource& source, const YamlField& field) {
    sign = source.choice(field, {"1", "-1"}) == "1" ? 1 : -1;
  };
  return mapKey(key, {textKey("name", name),
                      {"sign", read_sign, sign < 0 ? "-1" : "1"},
                      numberKey("offset", offset, unit, -largest, largest)});
}

ConfigKeys instrumentKeys(InstrumentConfig& instrument, AxisRule rule) {
  const auto read_marker = [&instrument](const YamlSource& source, const YamlField& field) {
    readMarker(source, field, instrument.marker);
  };
  const auto read_range = [&instrument](const YamlSource& source, const YamlField& field) {
    pairKey("", instrument.lower, instrument.upper, "m", -kMaxLength, kMaxLength).read(source, field);
    if (instrument.lower >= instrument.upper)
      source.fail(field, "does not have its lower end first; write [lower, upper]");
  };
  const ConfigKey marker = std::visit([](auto& design) { return markerKey(design); }, instrument.marker);
  ConfigKey ink = numberKey("ink", instrument.ink, "m", -kMaxInk, kMaxInk);
  if (instrument.ink == 0) ink.text.clear();
  ConfigKey turn = jointKey("rotation_joint", instrument.rotation_joint, instrument.rotation_sign,
                            instrument.rotation_offset, "rad");
  if (instrument.rotation_joint.empty()) turn.text.clear();
  return {
      textKey("name", instrument.name),
      {"marker", read_marker, blockText({marker}, "      "), true},
      ink,
      axisKey(instrument.axis, rule),
      {"range", read_range, listText(std::vector<double>{instrument.lower, instrument.upper}, "m"), true},
      numberKey("lateral_tolerance", instrument.lateral_tolerance, "m", 1e-6, kMaxLateral),
      mapKey("motion", motionKeys(instrument.motion)),
      required(jointKey("slide_joint", instrument.slide_joint, instrument.slide_sign, instrument.slide_offset, "m")),
      turn};
}

void checkUnique(const YamlSource& source, const YamlField& field, const InstrumentConfig& instrument,
                 const std::vector<InstrumentConfig>& others) {
  std::vector<std::string> joints{instrument.slide_joint, instrument.rotation_joint};
  for (const InstrumentConfig& other : others) {
    if (other.name == instrument.name)
      source.fail(field, "has the name '" + other.name + "' a second time; give each instrument a name of its own");
    joints.insert(joints.end(), {other.slide_joint, other.rotation_joint});
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (joints[i].empty() || std::count(joints.begin(), joints.end(), joints[i]) == 1) continue;
    source.fail(field, "moves the joint '" + joints[i] + "', which is already moved; give each joint one measurement");
  }
}

void checkAxis(const YamlSource& source, const YamlField& field, const InstrumentConfig& instrument,
               const CameraModel& camera) {
  constexpr double kNearest = 0.1;  // of the distance from the camera at slide 0
  bool seen = false;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double slide = instrument.lower + share * (instrument.upper - instrument.lower);
    if (1 + instrument.axis.perspective * slide < kNearest) {
      source.fail(field, "has a perspective with which the slide " + showQuantity(slide, "m") +
                             " would be behind the camera; correct 'perspective' or calibrate the axis again");
    }
    const Eigen::Vector2d point = pixelAt(instrument.axis, alongOf(instrument.axis, slide));
    const double margin = 0.25 * std::max(camera.width, camera.height);  // for the distortion
    seen = seen || (point.x() > -margin && point.x() < camera.width + margin && point.y() > -margin &&
                    point.y() < camera.height + margin);
  }
  if (seen) return;
  source.fail(field, "lies outside of the image of " + sizeText(camera.width, camera.height) +
                         " px over the whole range; correct camera.size or calibrate the axis again");
}

void checkTurn(const YamlSource& source, const YamlField& field, const MarkerDesign& marker) {
  if (std::holds_alternative<SleeveDesign>(marker)) return;
  source.fail(field,
              std::string("needs a sleeve, ") +
                  (std::holds_alternative<RingDesign>(marker) ? "a ring does not show the rotation"
                                                              : "a flat tag does not show the rotation of a rod") +
                  "; leave the key out or use a sleeve");
}

void readInstruments(const YamlSource& source, const YamlField& field, AxisRule rule, VisionConfig& config) {
  const std::vector<YamlField> items = source.list(field);
  if (items.empty() || items.size() > kMaxNamed) {
    source.fail(field, "has " + std::to_string(items.size()) + " instruments; describe 1 to " +
                           std::to_string(kMaxNamed) + " of them in lines that begin with '- name: ...'");
  }
  for (const YamlField& item : items) {
    InstrumentConfig instrument;
    for (const YamlField& entry : readMap(source, item, instrumentKeys(instrument, rule))) {
      if (entry.key == "rotation_joint") checkTurn(source, entry, instrument.marker);
      if (entry.key == "axis") checkAxis(source, entry, instrument, config.camera);
    }
    checkUnique(source, item, instrument, config.instruments);
    config.instruments.push_back(instrument);
  }
}

VisionConfig readConfig(const YamlSource& source, AxisRule rule) {
  VisionConfig config;
  std::vector<YamlField> instruments;
  const auto read_camera = [&config](const YamlSource& from, const YamlField& field) {
    readMap(from, field, cameraKeys(config));
    checkLens(from, field, config.camera);
  };
  const auto keep = [&instruments](const YamlSource&, const YamlField& field) { instruments.push_back(field); };
  readMap(source, source.root(),
          {{"camera", read_camera, "", true}, gatesKey(config.gates), {"instruments", keep, "", true}});
  // the checks of axes need the camera, wherever it stands in the file
  readInstruments(source, instruments.front(), rule, config);
  return config;
}

}  // namespace

VisionConfig VisionConfig::load(const std::string& address, AxisRule rule) {
  return readConfig(YamlSource::load(resolveAddress(address), {}), rule);
}

VisionConfig VisionConfig::parse(const std::string& yaml, const std::string& place, AxisRule rule) {
  return readConfig(YamlSource::parse(yaml, place, {}), rule);
}

std::string toYaml(const VisionConfig& config) {
  VisionConfig written = config;  // the tables of keys can read, too
  std::string text =
      "# What the camera sees of the instruments. Format: docs/vision.md, \"Configuration\".\n\ncamera:" +
      blockText(cameraKeys(written), "  ") + "\n" + blockText({gatesKey(written.gates)}, "") + "\n\ninstruments:";
  for (InstrumentConfig& instrument : written.instruments)
    text += "\n  - " + blockText(instrumentKeys(instrument, AxisRule::Optional), "    ").substr(5);
  return text + "\n";
}

}  // namespace vibe::vision
