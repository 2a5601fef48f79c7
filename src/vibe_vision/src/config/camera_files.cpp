#include "vibe_vision/config/camera_files.hpp"

#include <algorithm>
#include <vector>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::vision {
namespace {

constexpr int kMostPixels = 16384;      // of a side
constexpr double kLargestNumber = 1e6;  // of any number: errors of units are beyond
const char* const kOtherModel =
    "calibrate the lens with the pinhole model of this one, or with vibe_calibrate intrinsics";

class CameraFile {
 public:
  explicit CameraFile(const std::string& file) : source_(YamlSource::load(file, {})) {}

  CameraModel read(const std::string& camera) {
    const std::vector<YamlField> fields = source_.map(source_.root());
    const auto ros = [](const YamlField& field) { return field.key == "camera_matrix"; };
    return std::any_of(fields.begin(), fields.end(), ros) ? readRos() : readKalibr(chooseCamera(fields, camera));
  }

 private:
  YamlSource source_;

  YamlField get(const YamlField& parent, const std::string& key) const {
    for (const YamlField& field : source_.map(parent))
      if (field.key == key) return field;
    source_.fail(parent, "lacks the key '" + key + "'; give the file as its calibration wrote it");
  }

  std::vector<double> numbers(const YamlField& field, std::size_t count) const {
    return source_.quantities(field, count, "1", -kLargestNumber, kLargestNumber);
  }

  int pixels(const YamlField& field) const { return static_cast<int>(source_.integer(field, 1, kMostPixels)); }

  void requireModel(const YamlField& field, const std::string& model) const {
    const std::string found = source_.text(field);
    if (found != model) source_.fail(field, "is '" + found + "', only '" + model + "' is known here; " + kOtherModel);
  }

  CameraModel readRos() const {
    const YamlField root = source_.root();
    CameraModel camera;
    camera.width = pixels(get(root, "image_width"));
    camera.height = pixels(get(root, "image_height"));
    requireModel(get(root, "distortion_model"), "plumb_bob");
    const YamlField matrix = get(get(root, "camera_matrix"), "data");
    const std::vector<double> k = numbers(matrix, 9);
    if (k[1] != 0) source_.fail(matrix, std::string("has pixels that are not rectangular; ") + kOtherModel);
    setMatrix(matrix, {k[0], k[4], k[2], k[5]}, camera);
    const std::vector<double> d = numbers(get(get(root, "distortion_coefficients"), "data"), 5);
    std::copy(d.begin(), d.end(), camera.distortion.begin());
    return camera;
  }

  /// @param values  fx, fy, cx, cy
  void setMatrix(const YamlField& field, const std::vector<double>& values, CameraModel& camera) const {
    if (values[0] <= 0 || values[1] <= 0)
      source_.fail(field, "has a focal length that is not above 0 px; it may be of a camera that was never calibrated");
    camera.fx = values[0], camera.fy = values[1], camera.cx = values[2], camera.cy = values[3];
  }

  YamlField chooseCamera(const std::vector<YamlField>& fields, const std::string& camera) const {
    std::vector<std::string> names;
    for (const YamlField& field : fields)
      if (field.value.IsMap() && field.value["camera_model"]) names.push_back(field.key);
    if (names.empty()) {
      source_.fail(source_.root(),
                   "has neither the 'camera_matrix' of a ROS camera_info nor a camera with a 'camera_model' as a "
                   "camchain of Kalibr; give one of these files");
    }
    if (camera.empty() && names.size() > 1)
      throw Error(source_.place() + ": has " + std::to_string(names.size()) + " cameras; choose one, for example '" +
                  names[0] + "'");
    if (!camera.empty() && std::find(names.begin(), names.end(), camera) == names.end())
      throw Error(source_.place() + ": '" + camera + "' is not a camera in it; " + suggestKey(camera, names));
    return get(source_.root(), camera.empty() ? names[0] : camera);
  }

  CameraModel readKalibr(const YamlField& field) const {
    CameraModel camera;
    requireModel(get(field, "camera_model"), "pinhole");
    requireModel(get(field, "distortion_model"), "radtan");
    const YamlField resolution = get(field, "resolution");
    const std::vector<YamlField> size = source_.list(resolution);
    if (size.size() != 2) source_.fail(resolution, "does not have two values; write [728, 544]");
    camera.width = pixels(size[0]), camera.height = pixels(size[1]);
    const YamlField intrinsics = get(field, "intrinsics");
    setMatrix(intrinsics, numbers(intrinsics, 4), camera);
    const std::vector<double> d = numbers(get(field, "distortion_coeffs"), 4);
    std::copy(d.begin(), d.end(), camera.distortion.begin());
    return camera;
  }
};

std::string listOf(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + shortestText(value);
  return text + "]";
}

std::string matrix(const std::string& key, int rows, int columns, const std::vector<double>& values) {
  return key + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(columns) +
         "\n  data: " + listOf(values) + "\n";
}

std::string toRos(const CameraModel& c) {
  const std::vector<double> d(c.distortion.begin(), c.distortion.end());
  return "image_width: " + std::to_string(c.width) + "\nimage_height: " + std::to_string(c.height) +
         "\ncamera_name: camera\n" + matrix("camera_matrix", 3, 3, {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1}) +
         "distortion_model: plumb_bob\n" + matrix("distortion_coefficients", 1, 5, d) +
         matrix("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
         matrix("projection_matrix", 3, 4, {c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0});
}

std::string toKalibr(const CameraModel& c) {
  if (c.distortion[4] != 0) {
    throw Error("the lens has k3 = " + shortestText(c.distortion[4]) +
                ", which Kalibr's model 'radtan' does not have; write the format of ROS instead");
  }
  return "cam0:\n  camera_model: pinhole\n  intrinsics: " + listOf({c.fx, c.fy, c.cx, c.cy}) +
         "\n  distortion_model: radtan\n  distortion_coeffs: " +
         listOf({c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3]}) + "\n  resolution: [" +
         std::to_string(c.width) + ", " + std::to_string(c.height) + "]\n";
}

}  // namespace

CameraModel loadCameraFile(const std::string& file, const std::string& camera) {
  return CameraFile(file).read(camera);
}

std::string toCameraFile(const CameraModel& camera, CameraFileFormat format) {
  return format == CameraFileFormat::Ros ? toRos(camera) : toKalibr(camera);
}

}  // namespace vibe::vision
