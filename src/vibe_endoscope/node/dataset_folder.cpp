#include "dataset_folder.hpp"

#include <QImage>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "dataset/npy_file.hpp"
#include "vibe_graphics/messages/cloud_field.hpp"

namespace vibe::endoscope {
namespace {

constexpr int kDigits = 17;  // of a double that is read back exactly

void savePng(const std::string& file, const std::uint8_t* pixels, int width, int height, QImage::Format format) {
  const int channels = format == QImage::Format_RGB888 ? 3 : 1;
  const QImage image(pixels, width, height, channels * width, format);
  if (!image.save(QString::fromStdString(file), "PNG"))
    throw std::runtime_error("'" + file +
                             "' cannot be written; make room if the disk is full, or give another --output.");
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) result += c;
  }
  return result + "\"";
}

std::string pointText(const geometry_msgs::Point& point) {
  std::ostringstream text;
  text << std::setprecision(kDigits) << "[" << point.x << ", " << point.y << ", " << point.z << "]";
  return text.str();
}

std::string sutureText(const vibe_msgs::Suture& suture) {
  std::ostringstream text;
  text << std::setprecision(kDigits) << "{\"stage\": " << int{suture.stage} << ", \"thread\": [";
  for (std::size_t k = 0; k < suture.thread.size(); ++k) text << (k ? ", " : "") << pointText(suture.thread[k]);
  text << "], \"bites\": [";
  for (std::size_t k = 0; k < suture.bites.size(); ++k) text << (k ? ", " : "") << pointText(suture.bites[k].position);
  text << "], \"tension\": [";
  for (std::size_t k = 0; k < suture.tension.size(); ++k) text << (k ? ", " : "") << suture.tension[k];
  return text.str() + "]}";
}

/// What begins with a dot is of the script that calls this program.
bool isOfDataSet(const std::filesystem::path& path) {
  return path.filename().string()[0] != '.';
}

using Values = std::vector<std::pair<const char*, double>>;

std::string textOf(const Values& values) {
  std::ostringstream text;
  text << std::setprecision(kDigits);
  for (const auto& [name, value] : values) text << (text.tellp() > 0 ? ", \"" : "{\"") << name << "\": " << value;
  return text.str() + "}";
}

std::string textOf(const SensorStyle& s) {
  return textOf(Values{{"exposure", s.exposure},
                       {"red_gain", s.red_gain},
                       {"blue_gain", s.blue_gain},
                       {"vignetting", s.vignetting},
                       {"blur", s.blur},
                       {"distortion", s.distortion},
                       {"full_well", s.full_well},
                       {"read_noise", s.read_noise}});
}

std::string textOf(const graphics::MucosaLook& m) {
  return textOf(Values{{"shift_x", m.shift.x()},
                       {"shift_y", m.shift.y()},
                       {"shift_z", m.shift.z()},
                       {"areae_size", m.areae_size},
                       {"paleness", m.paleness},
                       {"yellowness", m.yellowness},
                       {"vessels", m.vessels},
                       {"wetness", m.wetness},
                       {"mucus", m.mucus}});
}

std::string textOf(const graphics::EndoscopeLight& light) {
  const auto& [right, left] = light.guides;
  return textOf(Values{{"right_guide_x", right.right},
                       {"right_guide_y", right.up},
                       {"right_guide_strength", right.strength},
                       {"left_guide_x", left.right},
                       {"left_guide_y", left.up},
                       {"left_guide_strength", left.strength},
                       {"sideward", light.sideward},
                       {"temperature", light.temperature}});
}

std::string variedText(const DatasetOptions& options) {
  std::string text;
  for (const auto& [name, on] : {std::pair("lens", options.vary_lens),
                                 {"sensor", options.vary_sensor},
                                 {"mucosa", options.vary_mucosa},
                                 {"light", options.vary_light}})
    if (on && options.seed != 0) text += (text.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  return "[" + text + "]";
}

}  // namespace

DatasetFolder::DatasetFolder(const DatasetOptions& options) : options_(options) {
  namespace fs = std::filesystem;
  std::error_code problem;
  is_new_ = !fs::exists(options.output, problem);
  fs::create_directories(options.output, problem);
  if (problem || !fs::is_directory(options.output))
    throw std::runtime_error("The folder '" + options.output + "' cannot be made (" +
                             (problem ? problem.message() : "it is a file") + "); give another --output.");
  for (const auto& entry : fs::directory_iterator(options.output))
    if (isOfDataSet(entry.path()))
      throw std::runtime_error("The folder '" + options.output + "' is not empty; give another --output or remove it.");
  const std::vector<std::string> lenses =
      options.stereo ? std::vector<std::string>{"left/", "right/"} : std::vector<std::string>{""};
  for (const std::string& lens : lenses)
    for (const auto& [kind, on] : {std::pair("image", true),
                                   {"depth", options.depth},
                                   {"normals", options.normals},
                                   {"labels", options.labels},
                                   {"flow", options.flow},
                                   {"flow_visible", options.flow}})
      if (on) fs::create_directories(options.output + "/" + lens + kind);
  if (options.particles) fs::create_directories(options.output + "/particles");
  if (options.particles) fs::create_directories(options.output + "/topology");
  if (options.sutures) fs::create_directories(options.output + "/sutures");
  times_.open(options.output + "/times.txt");
  poses_.open(options.output + "/poses.txt");
  times_ << "# number of the image, stamp [s]\n";
  poses_
      << "# stamp [s], tx ty tz [m], qx qy qz qw: pose of the camera (z forward, x right, y down) in the frame of the "
         "particles\n";
}

DatasetFolder::~DatasetFolder() {
  if (is_finished_) return;
  namespace fs = std::filesystem;
  times_.close(), poses_.close();
  std::error_code ignored;
  std::vector<fs::path> ours;
  for (const auto& entry : fs::directory_iterator(options_.output, ignored))
    if (isOfDataSet(entry.path())) ours.push_back(entry.path());
  for (const fs::path& path : ours) fs::remove_all(path, ignored);
  if (is_new_) fs::remove(options_.output, ignored);  // if nothing else is in it
}

std::string DatasetFolder::fileOf(const std::string& lens, const char* kind, std::size_t number,
                                  const char* ending) const {
  char name[16];
  std::snprintf(name, sizeof name, "%06zu", number);
  return options_.output + "/" + lens + kind + "/" + name + ending;
}

void DatasetFolder::addImage(std::size_t number, const ros::Time& stamp, const Eigen::Isometry3d& camera) {
  const Eigen::Vector3d& t = camera.translation();
  const Eigen::Quaterniond q(camera.linear());
  char line[256];
  std::snprintf(line, sizeof line, "%d.%09d", stamp.sec, stamp.nsec);
  times_ << std::setw(6) << std::setfill('0') << number << " " << line << "\n";
  poses_ << line << std::setprecision(12) << " " << t.x() << " " << t.y() << " " << t.z() << " " << q.x() << " "
         << q.y() << " " << q.z() << " " << q.w() << "\n";
  if (images_++ == 0) first_ = stamp.toSec();
  last_ = stamp.toSec();
}

void DatasetFolder::writeColour(const std::string& lens, std::size_t number, const std::vector<std::uint8_t>& pixels) {
  savePng(fileOf(lens, "image", number, ".png"), pixels.data(), options_.round.width, options_.round.height,
          QImage::Format_RGB888);
}

void DatasetFolder::writeTruth(const std::string& lens, std::size_t number, const TruthCamera& camera,
                               const TruthScene& scene, const TruthView& view) {
  const auto width = static_cast<std::size_t>(options_.round.width);
  const auto height = static_cast<std::size_t>(options_.round.height);
  if (options_.depth) writeNpy(fileOf(lens, "depth", number, ".npy"), {height, width}, camera.depth(scene, view));
  if (options_.normals)
    writeHalfNpy(fileOf(lens, "normals", number, ".npy"), {height, width, 3}, camera.normals(scene, view));
  if (!options_.labels) return;
  const std::vector<std::uint8_t> labels = camera.labels(scene, view);
  for (const std::uint8_t label : labels) ++pixels_[label];
  savePng(fileOf(lens, "labels", number, ".png"), labels.data(), options_.round.width, options_.round.height,
          QImage::Format_Grayscale8);
}

void DatasetFolder::writeFlow(const std::string& lens, std::size_t number, const TruthFlow& flow) {
  const auto width = static_cast<std::size_t>(options_.round.width);
  writeNpy(fileOf(lens, "flow", number, ".npy"), {static_cast<std::size_t>(options_.round.height), width, 2},
           flow.motion);
  savePng(fileOf(lens, "flow_visible", number, ".png"), flow.visible.data(), options_.round.width,
          options_.round.height, QImage::Format_Grayscale8);
}

void DatasetFolder::writeParticles(std::size_t number, const sensor_msgs::PointCloud2& particles) {
  graphics::CloudField field[3];
  const char* const names[3] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    graphics::findField(particles, names[k], sensor_msgs::PointField::FLOAT32, true, field[k]);
  const std::size_t count = std::size_t{particles.width} * particles.height;
  std::vector<float> places;
  for (std::size_t i = 0; i < count; ++i)
    for (const graphics::CloudField& axis : field) places.push_back(axis.at<float>(i));
  writeNpy(fileOf("", "particles", number, ".npy"), {count, 3}, places);
}

void DatasetFolder::writeTopology(const vibe_msgs::TissueTopology& topology) {
  const std::string folder = options_.output + "/topology/";
  writeNpy(folder + "triangles.npy", {topology.triangles.size() / 3, 3}, topology.triangles);
  const std::vector<float> rest(topology.rest_positions.begin(), topology.rest_positions.end());
  writeNpy(folder + "rest_positions.npy", {rest.size() / 3, 3}, rest);
  if (topology.render_offsets.empty()) return;
  writeNpy(folder + "render_triangles.npy", {topology.render_triangles.size() / 3, 3}, topology.render_triangles);
  writeNpy(folder + "render_offsets.npy", {topology.render_offsets.size()}, topology.render_offsets);
  writeNpy(folder + "render_particles.npy", {topology.render_particles.size()}, topology.render_particles);
  writeNpy(folder + "render_weights.npy", {topology.render_weights.size()}, topology.render_weights);
}

void DatasetFolder::writeSutures(std::size_t number, const vibe_msgs::SutureArray& sutures) {
  std::string text = "[\n";
  for (std::size_t k = 0; k < sutures.sutures.size(); ++k)
    text += sutureText(sutures.sutures[k]) + (k + 1 < sutures.sutures.size() ? ",\n" : "\n");
  char name[32];
  std::snprintf(name, sizeof name, "sutures/%06zu.json", number);
  writeText(name, text + "]\n");
}

void DatasetFolder::writeText(const std::string& name, const std::string& text) {
  std::ofstream out(options_.output + "/" + name);
  out << text;
  out.close();
  if (!out)
    throw std::runtime_error("'" + options_.output + "/" + name +
                             "' cannot be written; make room if the disk is full, or give another --output.");
}

std::string DatasetFolder::intrinsics() const {
  const graphics::CameraNumbers numbers = graphics::numbersOf(options_.round, options_.stereo ? options_.baseline : 0);
  std::ostringstream text;
  text << std::setprecision(kDigits) << "{\n\"width\": " << options_.round.width
       << ",\n\"height\": " << options_.round.height << ",\n\"model\": \"" << numbers.distortion_model
       << "\",\n\"field_of_view\": " << options_.round.field_of_view / graphics::kDegree
       << ",\n\"fx\": " << numbers.k[0] << ",\n\"fy\": " << numbers.k[4] << ",\n\"cx\": " << numbers.k[2]
       << ",\n\"cy\": " << numbers.k[5] << ",\n\"radius\": " << options_.round.radius()
       << ",\n\"distortion_of_truth\": [";
  for (std::size_t k = 0; k < numbers.d.size(); ++k) text << (k ? ", 0" : "0");
  text << "],\n\"distortion_of_image\": [" << options_.sensor.distortion;
  for (std::size_t k = 1; k < numbers.d.size(); ++k) text << ", 0";
  text << "],\n\"baseline\": " << (options_.stereo ? options_.baseline : 0) << "\n}\n";
  return text.str();
}

std::string DatasetFolder::description(const vibe_msgs::SessionInfo& info, const std::string& frame) const {
  std::ostringstream text;
  text << std::setprecision(kDigits) << "{\n\"recording\": " << quoted(options_.name)
       << ",\n\"version\": " << quoted(info.version) << ",\n\"arithmetic\": " << quoted(info.arithmetic)
       << ",\n\"scene_hash\": \"" << std::hex << info.scene_hash << "\",\n\"urdf_hash\": \"" << info.urdf_hash
       << "\",\n\"model_hash\": \"" << info.model_hash << std::dec << "\",\n\"frame\": " << quoted(frame)
       << ",\n\"images\": " << images_ << ",\n\"first\": " << first_ << ",\n\"last\": " << last_
       << ",\n\"rate\": " << options_.rate << ",\n\"every\": " << options_.every << ",\n\"lens\": \""
       << (options_.round.lens == graphics::LensKind::Equidistant ? "equidistant" : "rectilinear")
       << "\",\n\"stereo\": " << (options_.stereo ? "true" : "false") << ",\n\"content\": [\"image\"";
  for (const auto& [name, on] : {std::pair("depth", options_.depth),
                                 {"normals", options_.normals},
                                 {"labels", options_.labels},
                                 {"flow", options_.flow},
                                 {"particles", options_.particles},
                                 {"sutures", options_.sutures}})
    if (on) text << ", \"" << name << "\"";
  text << "],\n\"seed\": " << options_.seed << ",\n\"varied\": " << variedText(options_)
       << ",\n\"mount\": {\"roll\": " << options_.roll << ", \"pitch\": " << options_.pitch
       << ", \"yaw\": " << options_.yaw << "},\n\"sensor\": " << textOf(options_.sensor)
       << ",\n\"mucosa\": " << textOf(options_.mucosa) << ",\n\"light\": " << textOf(options_.light)
       << ",\n\"label_pixels\": {";
  bool first = true;
  for (std::size_t k = 0; k < pixels_.size(); ++k)
    if (pixels_[k] > 0) text << (first ? "" : ", ") << "\"" << k << "\": " << pixels_[k], first = false;
  text << "},\n\"scene\": ";
  // the scene is text with line breaks
  std::string scene;
  for (const char c : info.scene)
    scene += c == '\n' ? std::string("\\n") : c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return text.str() + "\"" + scene + "\"\n}\n";
}

void DatasetFolder::finish(const vibe_msgs::SessionInfo& info, const std::string& labels, const std::string& frame) {
  times_.close(), poses_.close();
  if (!times_ || !poses_)
    throw std::runtime_error("times.txt or poses.txt in '" + options_.output +
                             "' cannot be written; make room if the disk is full, or give another --output.");
  writeText("intrinsics.json", intrinsics());
  writeText("labels.json", labels);
  writeText("dataset.json", description(info, frame));
  is_finished_ = true;
}

}  // namespace vibe::endoscope
