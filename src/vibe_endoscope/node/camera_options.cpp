#include "camera_options.hpp"

#include <stdexcept>

#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::endoscope {
namespace {

using ros_utils::ParameterReader;

[[noreturn]] void reject(const ros::NodeHandle& node, const std::string& name, const std::string& what) {
  throw std::runtime_error("Parameter " + node.resolveName(name) + " must be " + what + ".");
}

graphics::LensKind lensOf(const std::string& word, const ros::NodeHandle& node) {
  if (word == "equidistant") return graphics::LensKind::Equidistant;
  if (word == "rectilinear") return graphics::LensKind::Rectilinear;
  reject(node, "lens", "equidistant or rectilinear");
}

void readFrame(ParameterReader& reader, const ros::NodeHandle& node, const std::string& name, std::string& value) {
  reader.read(name, value);
  if (value.empty()) reject(node, name, "the name of a frame");
}

/// The parameters of the sensor.
void readSensor(ParameterReader& reader, SensorStyle& sensor) {
  int seed = 0;
  reader.read("exposure", sensor.exposure, 0.05, 20, "");
  reader.read("red_gain", sensor.red_gain, 0.5, 2, "");
  reader.read("blue_gain", sensor.blue_gain, 0.5, 2, "");
  reader.read("vignetting", sensor.vignetting, 0, 1, "");
  reader.read("blur", sensor.blur, 0, 10, "px");
  reader.read("distortion", sensor.distortion, -0.2, 0.2, "");
  reader.read("full_well", sensor.full_well, 0, 1e6, "");
  reader.read("read_noise", sensor.read_noise, 0, 0.5, "");
  reader.read("noise_seed", seed, 0, 2147483647);
  sensor.seed = static_cast<std::uint32_t>(seed);
}

}  // namespace

CameraOptions readCameraOptions(const ros::NodeHandle& node) {
  CameraOptions options;
  ParameterReader reader(node);
  double degrees = 140;
  std::string lens = "equidistant";
  reader.read("width", options.round.width, 16, 4096);
  reader.read("height", options.round.height, 16, 4096);
  reader.read("lens", lens);
  options.round.lens = lensOf(lens, node);
  reader.read("field_of_view", degrees, 10, 170, "");
  reader.read("sharpness", options.sharpness, 0.2, 2, "");
  reader.read("rate", options.rate, 0, 1000, "Hz");
  reader.read("auto_exposure", options.auto_exposure);
  reader.read("smoke", options.smoke);
  reader.read("stereo", options.stereo);
  reader.read("baseline", options.baseline, 0.0001, 0.1, "m");
  readFrame(reader, node, "camera_frame", options.camera_frame);
  options.frame_id = options.camera_frame;
  readFrame(reader, node, "frame_id", options.frame_id);
  options.right_frame_id = options.frame_id;
  readFrame(reader, node, "right_frame_id", options.right_frame_id);
  readSensor(reader, options.sensor);
  reader.finish();
  options.round.field_of_view = degrees * graphics::kDegree;
  const std::string problem = problemOf(options.sensor, options.round);
  if (!problem.empty()) throw std::runtime_error("Parameter " + node.resolveName("distortion") + ": " + problem + ".");
  return options;
}

}  // namespace vibe::endoscope
