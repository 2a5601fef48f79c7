#include "dataset_camera.hpp"

#include "vibe_graphics/graphics/endoscope_lamp.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"

namespace vibe::endoscope {
namespace {

constexpr const char* kCameraFrame = "scope_camera_optical";

}  // namespace

DatasetCamera::DatasetCamera(const DatasetOptions& options, Ogre::SceneManager& scene, const std::string& description)
    : options_(options),
      drawn_(scene, description, options.smoke, options.mucosa),
      truth_(description),
      camera_(scene, options.round, 1),
      truth_camera_(options.round, static_cast<double>(graphics::kScopeNearClip),
                    static_cast<double>(graphics::kScopeFarClip)),
      sensor_(options.sensor, options.round) {
  graphics::setLamp(options.light);
  eyes_.push_back({options.stereo ? "left/" : "", 0, {}});
  if (options.stereo) eyes_.push_back({"right/", options.baseline, {}});
}

std::string DatasetCamera::take(const SessionFrame& frame, const JointTree& poses, DatasetFolder& folder) {
  const std::string& world = frame.particles->header.frame_id;
  const EndoscopeScene::PoseOf pose_of = [&](const std::string& name) { return poses.pose(name, world); };
  const std::optional<Eigen::Isometry3d> mount = pose_of(kCameraFrame);
  if (!mount) return std::string("Nothing tells where the frame '") + kCameraFrame + "' is in '" + world + "'.";
  using Eigen::Vector3d;
  const Eigen::Isometry3d camera = *mount * Eigen::Isometry3d(Eigen::AngleAxisd(options_.yaw, Vector3d::UnitY()) *
                                                              Eigen::AngleAxisd(options_.pitch, Vector3d::UnitX()) *
                                                              Eigen::AngleAxisd(options_.roll, Vector3d::UnitZ()));
  const std::string problem = show(frame, camera, pose_of);
  if (!problem.empty()) return problem;
  if (options_.particles && topology_ && topology_ != written_topology_) folder.writeTopology(*topology_);
  written_topology_ = topology_;
  const ros::Time stamp = frame.particles->header.stamp;
  folder.addImage(images_, stamp, camera);
  if (options_.particles) folder.writeParticles(images_, *frame.particles);
  if (options_.sutures && frame.sutures) folder.writeSutures(images_, *frame.sutures);
  for (Eye& eye : eyes_) takeEye(eye, camera * Eigen::Translation3d(eye.aside, 0, 0), stamp, folder);
  ++images_;
  return "";
}

std::string DatasetCamera::follow(const SessionFrame& frame) {
  if (frame.topology && frame.topology != topology_) {
    const std::string problem = drawn_.setTopology(*frame.topology);
    truth_.setTopology(*frame.topology);
    topology_ = frame.topology;
    if (!problem.empty()) return problem;
  }
  return drawn_.followParticles(*frame.particles);
}

std::string DatasetCamera::show(const SessionFrame& frame, const Eigen::Isometry3d& camera,
                                const EndoscopeScene::PoseOf& pose_of) {
  std::string problem = drawn_.setParticles(*frame.particles);
  if (problem.empty()) problem = truth_.setParticles(*frame.particles);
  if (problem.empty() && frame.sutures && frame.sutures != sutures_) {
    problem = drawn_.setSutures(*frame.sutures, pose_of);
    truth_.setSutures(*frame.sutures, pose_of);
    sutures_ = frame.sutures;
  }
  if (!problem.empty()) return problem;
  drawn_.drawBlood();
  drawn_.placeInstrument(pose_of);
  truth_.placeInstrument(pose_of);
  truth_.pressOnLens(camera);
  truth_.commit();
  return "";
}

void DatasetCamera::takeEye(Eye& eye, const Eigen::Isometry3d& pose, const ros::Time& stamp, DatasetFolder& folder) {
  std::vector<std::uint8_t> pixels;
  camera_.take(pose, stamp.toSec(), pixels);
  sensor_.expose(pixels, 2 * stamp.toNSec() + (eye.aside > 0 ? 1 : 0));
  folder.writeColour(eye.folder, images_, pixels);
  if (options_.flow && eye.before)
    folder.writeFlow(eye.folder, images_ - 1, truth_camera_.flow(*eye.before, truth_.scene(), pose));
  TruthView view;
  truth_camera_.look(truth_.scene(), pose, view);
  folder.writeTruth(eye.folder, images_, truth_camera_, truth_.scene(), view);
  eye.before = std::move(view);
}

}  // namespace vibe::endoscope
