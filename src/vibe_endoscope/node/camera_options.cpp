#include "camera_options.hpp"

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

namespace vibe::endoscope {
namespace {

/// Reads parameters and remembers their names, so that any other parameter is an error.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& node) : node_(node) {}

  void number(const std::string& name, double min, double max, double& value) {
    if (!has(name)) return;
    // accepts integers and floating-point numbers
    if (!node_.getParam(name, value) || !(value >= min && value <= max)) {
      std::ostringstream range;
      range << "a number from " << min << " to " << max;
      reject(name, range.str());
    }
  }
  void whole(const std::string& name, int min, int max, int& value) {
    if (has(name) && (!node_.getParam(name, value) || value < min || value > max))
      reject(name, "a whole number from " + std::to_string(min) + " to " + std::to_string(max));
  }
  void yesOrNo(const std::string& name, bool& value) {
    if (has(name) && !node_.getParam(name, value)) reject(name, "true or false");
  }
  void text(const std::string& name, std::string& value) {
    if (has(name) && (!node_.getParam(name, value) || value.empty())) reject(name, "the name of a frame");
  }
  void lens(const std::string& name, graphics::LensKind& value) {
    if (!has(name)) return;
    std::string word;
    node_.getParam(name, word);
    if (word != "equidistant" && word != "rectilinear") reject(name, "equidistant or rectilinear");
    value = word == "equidistant" ? graphics::LensKind::Equidistant : graphics::LensKind::Rectilinear;
  }

  void rejectOthers() const {
    XmlRpc::XmlRpcValue all;
    if (!node_.getParam(node_.getNamespace(), all) || all.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
    std::string list;
    for (const std::string& name : known_) list += (list.empty() ? "" : ", ") + name;
    for (const auto& entry : all)
      if (known_.count(entry.first) == 0)
        throw std::runtime_error("There is no parameter '" + node_.resolveName(entry.first) + "'; known are " + list +
                                 ".");
  }

 private:
  bool has(const std::string& name) {
    known_.insert(name);
    return node_.hasParam(name);
  }
  [[noreturn]] void reject(const std::string& name, const std::string& what) const {
    throw std::runtime_error("The parameter '" + node_.resolveName(name) + "' must be " + what + ".");
  }

  const ros::NodeHandle& node_;
  std::set<std::string> known_;
};

/// The parameters of the sensor.
void readSensor(Reader& read, SensorStyle& sensor) {
  int seed = 0;
  read.number("exposure", 0.05, 20, sensor.exposure);
  read.number("red_gain", 0.5, 2, sensor.red_gain);
  read.number("blue_gain", 0.5, 2, sensor.blue_gain);
  read.number("vignetting", 0, 1, sensor.vignetting);
  read.number("blur", 0, 10, sensor.blur);
  read.number("distortion", -0.2, 0.2, sensor.distortion);
  read.number("full_well", 0, 1e6, sensor.full_well);
  read.number("read_noise", 0, 0.5, sensor.read_noise);
  read.whole("noise_seed", 0, 2147483647, seed);
  sensor.seed = static_cast<std::uint32_t>(seed);
}

}  // namespace

CameraOptions readCameraOptions(const ros::NodeHandle& node) {
  CameraOptions options;
  Reader read(node);
  double degrees = 140;
  read.whole("width", 16, 4096, options.round.width);
  read.whole("height", 16, 4096, options.round.height);
  read.lens("lens", options.round.lens);
  read.number("field_of_view", 10, 170, degrees);
  read.number("sharpness", 0.2, 2, options.sharpness);
  read.number("rate", 0, 1000, options.rate);
  read.yesOrNo("auto_exposure", options.auto_exposure);
  read.yesOrNo("smoke", options.smoke);
  read.yesOrNo("stereo", options.stereo);
  read.number("baseline", 0.0001, 0.1, options.baseline);
  read.text("camera_frame", options.camera_frame);
  options.frame_id = options.camera_frame;
  read.text("frame_id", options.frame_id);
  options.right_frame_id = options.frame_id;
  read.text("right_frame_id", options.right_frame_id);
  readSensor(read, options.sensor);
  read.rejectOthers();
  options.round.field_of_view = degrees * graphics::kDegree;
  const std::string problem = problemOf(options.sensor, options.round);
  if (!problem.empty())
    throw std::runtime_error("The parameter '" + node.resolveName("distortion") + "': " + problem + ".");
  return options;
}

}  // namespace vibe::endoscope
