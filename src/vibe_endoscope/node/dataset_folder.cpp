#include "dataset_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <QImage>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "dataset/npy_file.hpp"
#include "vibe_graphics/messages/cloud_field.hpp"

namespace vibe::endoscope {
namespace {

using Json = nlohmann::ordered_json;  // writes numbers so that they read back exactly, and what is none as null

void savePng(const std::string& file, const std::uint8_t* pixels, int width, int height, QImage::Format format) {
  const int channels = format == QImage::Format_RGB888 ? 3 : 1;
  const QImage image(pixels, width, height, channels * width, format);
  if (!image.save(QString::fromStdString(file), "PNG"))  // not whole: the folder is
    throw std::runtime_error("'" + file +
                             "' cannot be written; make room if the disk is full, or give another --output.");
}

Json jsonOf(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

Json jsonOf(const vibe_msgs::Suture& suture) {
  Json thread = Json::array(), bites = Json::array();
  for (const geometry_msgs::Point& point : suture.thread) thread.push_back(jsonOf(point));
  for (const auto& bite : suture.bites) bites.push_back(jsonOf(bite.position));
  return {{"stage", int{suture.stage}}, {"thread", thread}, {"bites", bites}, {"tension", suture.tension}};
}

/// What begins with a dot is of the script that calls this program.
bool isOfDataSet(const std::filesystem::path& path) {
  return path.filename().string()[0] != '.';
}

Json jsonOf(const SensorStyle& s) {
  return {
      {"exposure", s.exposure}, {"red_gain", s.red_gain},     {"blue_gain", s.blue_gain}, {"vignetting", s.vignetting},
      {"blur", s.blur},         {"distortion", s.distortion}, {"full_well", s.full_well}, {"read_noise", s.read_noise}};
}

Json jsonOf(const graphics::MucosaLook& m) {
  return {{"shift_x", m.shift.x()},     {"shift_y", m.shift.y()}, {"shift_z", m.shift.z()},
          {"areae_size", m.areae_size}, {"paleness", m.paleness}, {"yellowness", m.yellowness},
          {"vessels", m.vessels},       {"wetness", m.wetness},   {"mucus", m.mucus}};
}

Json jsonOf(const graphics::EndoscopeLight& light) {
  const auto& [right, left] = light.guides;
  return {{"right_guide_x", right.right}, {"right_guide_y", right.up},       {"right_guide_strength", right.strength},
          {"left_guide_x", left.right},   {"left_guide_y", left.up},         {"left_guide_strength", left.strength},
          {"sideward", light.sideward},   {"temperature", light.temperature}};
}

/// The names of what is on.
Json namesOf(std::initializer_list<std::pair<const char*, bool>> choices) {
  Json names = Json::array();
  for (const auto& [name, on] : choices)
    if (on) names.push_back(name);
  return names;
}

std::string hex(std::uint64_t number) {
  std::ostringstream text;
  text << std::hex << number;
  return text.str();
}

}  // namespace

DatasetFolder::DatasetFolder(const DatasetOptions& options)
    : options_(options), folder_(options.output + "/.part-dataset") {
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
  fs::remove_all(folder_, problem);  // of a call that was killed
  const std::vector<std::string> lenses =
      options.stereo ? std::vector<std::string>{"left/", "right/"} : std::vector<std::string>{""};
  for (const std::string& lens : lenses)
    for (const auto& [kind, on] : {std::pair("image", true),
                                   {"depth", options.depth},
                                   {"normals", options.normals},
                                   {"labels", options.labels},
                                   {"flow", options.flow},
                                   {"flow_visible", options.flow}})
      if (on) fs::create_directories(folder_ + "/" + lens + kind);
  if (options.particles) fs::create_directories(folder_ + "/particles");
  if (options.particles) fs::create_directories(folder_ + "/topology");
  if (options.sutures) fs::create_directories(folder_ + "/sutures");
  times_.open(folder_ + "/times.txt");  // not whole: the folder is
  poses_.open(folder_ + "/poses.txt");
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
  fs::remove_all(folder_, ignored);
  if (is_new_) fs::remove(options_.output, ignored);  // if nothing else is in it
}

std::string DatasetFolder::fileOf(const std::string& lens, const char* kind, std::size_t number,
                                  const char* ending) const {
  char name[16];
  std::snprintf(name, sizeof name, "%06zu", number);
  return folder_ + "/" + lens + kind + "/" + name + ending;
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
  const std::string folder = folder_ + "/topology/";
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
  Json json = Json::array();
  for (const vibe_msgs::Suture& suture : sutures.sutures) json.push_back(jsonOf(suture));
  char name[32];
  std::snprintf(name, sizeof name, "sutures/%06zu.json", number);
  writeText(name, json.dump() + "\n");
}

void DatasetFolder::writeText(const std::string& name, const std::string& text) {
  std::ofstream out(folder_ + "/" + name);  // not whole: the folder is
  out << text;
  out.close();
  if (!out)
    throw std::runtime_error("'" + options_.output + "/" + name +
                             "' cannot be written; make room if the disk is full, or give another --output.");
}

std::string DatasetFolder::intrinsics() const {
  const graphics::CameraNumbers numbers = graphics::numbersOf(options_.round, options_.stereo ? options_.baseline : 0);
  std::vector<double> of_image(numbers.d.size(), 0);
  of_image[0] = options_.sensor.distortion;
  const Json json{{"width", options_.round.width},
                  {"height", options_.round.height},
                  {"model", numbers.distortion_model},
                  {"field_of_view", options_.round.field_of_view / graphics::kDegree},
                  {"fx", numbers.k[0]},
                  {"fy", numbers.k[4]},
                  {"cx", numbers.k[2]},
                  {"cy", numbers.k[5]},
                  {"radius", options_.round.radius()},
                  {"distortion_of_truth", std::vector<int>(numbers.d.size(), 0)},
                  {"distortion_of_image", of_image},
                  {"baseline", options_.stereo ? options_.baseline : 0}};
  return json.dump(1) + "\n";
}

std::string DatasetFolder::description(const vibe_msgs::SessionInfo& info, const std::string& frame) const {
  const DatasetOptions& o = options_;
  const Json content = namesOf({{"image", true},
                                {"depth", o.depth},
                                {"normals", o.normals},
                                {"labels", o.labels},
                                {"flow", o.flow},
                                {"particles", o.particles},
                                {"sutures", o.sutures}});
  const bool varies = o.seed != 0;
  const Json varied = namesOf({{"lens", varies && o.vary_lens},
                               {"sensor", varies && o.vary_sensor},
                               {"mucosa", varies && o.vary_mucosa},
                               {"light", varies && o.vary_light}});
  Json label_pixels = Json::object();
  for (std::size_t k = 0; k < pixels_.size(); ++k)
    if (pixels_[k] > 0) label_pixels[std::to_string(k)] = pixels_[k];
  const Json json{{"recording", o.name},
                  {"version", info.version},
                  {"arithmetic", info.arithmetic},
                  {"scene_hash", hex(info.scene_hash)},
                  {"urdf_hash", hex(info.urdf_hash)},
                  {"model_hash", hex(info.model_hash)},
                  {"frame", frame},
                  {"images", images_},
                  {"first", first_},
                  {"last", last_},
                  {"rate", o.rate},
                  {"every", o.every},
                  {"lens", o.round.lens == graphics::LensKind::Equidistant ? "equidistant" : "rectilinear"},
                  {"stereo", o.stereo},
                  {"content", content},
                  {"seed", o.seed},
                  {"varied", varied},
                  {"mount", {{"roll", o.roll}, {"pitch", o.pitch}, {"yaw", o.yaw}}},
                  {"sensor", jsonOf(o.sensor)},
                  {"mucosa", jsonOf(o.mucosa)},
                  {"light", jsonOf(o.light)},
                  {"label_pixels", label_pixels},
                  {"scene", info.scene}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void DatasetFolder::finish(const vibe_msgs::SessionInfo& info, const std::string& labels, const std::string& frame) {
  times_.close(), poses_.close();
  if (!times_ || !poses_)
    throw std::runtime_error("times.txt or poses.txt in '" + options_.output +
                             "' cannot be written; make room if the disk is full, or give another --output.");
  writeText("intrinsics.json", intrinsics());
  writeText("labels.json", labels);
  writeText("dataset.json", description(info, frame));
  putInPlace();
  is_finished_ = true;
}

void DatasetFolder::putInPlace() const {
  namespace fs = std::filesystem;
  const int descriptor = ::open(folder_.c_str(), O_RDONLY | O_CLOEXEC);
  ::syncfs(descriptor);  // thousands of files at once
  ::close(descriptor);
  const fs::path last = fs::path(folder_) / "dataset.json";
  std::vector<fs::path> made;
  for (const auto& entry : fs::directory_iterator(folder_))
    if (entry.path() != last) made.push_back(entry.path());
  made.push_back(last);
  for (const fs::path& path : made) fs::rename(path, options_.output / path.filename());
  fs::remove(folder_);
}

}  // namespace vibe::endoscope
