// vibe_dataset: images with their truth from a whole recording, without a roscore and without a screen.
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <rviz/ogre_helpers/render_system.h>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "dataset_folder.hpp"
#include "endoscope_scene.hpp"
#include "image_due.hpp"
#include "robot_shapes.hpp"
#include "sensor/sensor_model.hpp"
#include "truth_world.hpp"
#include "vibe_graphics/graphics/endoscope_lamp.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/graphics/virtual_display.hpp"

namespace vibe::endoscope {
namespace {

constexpr int kFailure = 1;
constexpr auto kProgressPeriod = std::chrono::seconds(2);
constexpr const char* kCameraFrame = "scope_camera_optical";

/// Takes the images of a data set: what is drawn, and the truth, at chosen states of a session.
class DatasetCamera {
 public:
  /// @throws std::runtime_error  the graphics system or Embree cannot be used
  DatasetCamera(const DatasetOptions& options, Ogre::SceneManager& scene, const std::string& description)
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

  /// To be told of each state in order, taken or not, so that smoke and the age of marks do not depend on the choice.
  /// @return one sentence if the state is wrong
  std::string follow(const SessionFrame& frame) {
    if (frame.topology && frame.topology != topology_) {
      const std::string problem = drawn_.setTopology(*frame.topology);
      truth_.setTopology(*frame.topology);
      topology_ = frame.topology;
      if (!problem.empty()) return problem;
    }
    return drawn_.followParticles(*frame.particles);
  }

  /// Takes the state that follow() was told last.
  /// @return one sentence if the state is wrong; then nothing is written
  std::string take(const SessionFrame& frame, const JointTree& poses, DatasetFolder& folder) {
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

  std::size_t images() const { return images_; }
  std::string labels() const { return truth_.labels(); }

 private:
  struct Eye {
    std::string folder;
    double aside;                     // to the right of the camera frame [m]
    std::optional<TruthView> before;  // from which the flow starts
  };

  std::string show(const SessionFrame& frame, const Eigen::Isometry3d& camera, const EndoscopeScene::PoseOf& pose_of) {
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

  void takeEye(Eye& eye, const Eigen::Isometry3d& pose, const ros::Time& stamp, DatasetFolder& folder) {
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

  DatasetOptions options_;
  EndoscopeScene drawn_;
  TruthWorld truth_;
  graphics::OffscreenCamera camera_;
  TruthCamera truth_camera_;
  SensorModel sensor_;
  std::vector<Eye> eyes_;
  vibe_msgs::TissueTopology::ConstPtr topology_, written_topology_;
  vibe_msgs::SutureArray::ConstPtr sutures_;
  std::size_t images_ = 0;
};

/// Prints how far it is, now and then.
class Progress {
 public:
  void show(const SessionFrames& frames, std::size_t images) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < kProgressPeriod) return;
    last_ = now;
    std::printf("%3.0f %%  %zu images\n", 100 * frames.progress(), images);
    std::fflush(stdout);
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::string timeText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

std::runtime_error wrongState(const DatasetOptions& options, const ros::Time& stamp, const std::string& problem) {
  const std::string what = problem.substr(0, problem.find(';'));  // then: what a display does about it
  return std::runtime_error("The state at " + timeText(stamp.toSec()) + " s of '" + options.name +
                            "' cannot be used; end before it with --to, or record again: " + what);
}

/// A part that is not there would be missing in image and truth.
void refuseMissingMeshes(const std::string& urdf, const std::string& recording) {
  std::vector<std::string> problems;
  robotShapes(urdf, problems);
  if (!problems.empty())
    throw std::runtime_error("The instrument of '" + recording + "' cannot be shown whole: " + problems.front());
}

void run(const DatasetOptions& options) {
  const std::string impossible = problemOf(options.sensor, options.round);
  if (!impossible.empty())
    throw std::runtime_error("--seed " + std::to_string(options.seed) + " does not go with this lens: " + impossible +
                             ", or give another seed.");
  SessionFrames frames(options.bag);
  if (options.from > frames.end())
    throw std::runtime_error("--from: '" + options.name + "' ends at " + timeText(frames.end()) +
                             " s; give a time before that.");
  refuseMissingMeshes(frames.info().urdf, options.name);
  if (options.check) return;
  std::optional<DatasetFolder> folder;  // made with the first image, so that a refusal leaves nothing
  graphics::provideDisplay();
  rviz::RenderSystem::forceNoStereo();
  Ogre::SceneManager* scene = rviz::RenderSystem::get()->root()->createSceneManager();
  graphics::loadResources();
  DatasetCamera camera(options, *scene, frames.info().urdf);
  ImageDue due(options.rate);
  SessionFrame frame;
  Progress progress;
  std::string world;
  for (int turn = 0; frames.next(frame);) {
    const ros::Time stamp = frame.particles->header.stamp;
    if (stamp.toSec() > options.to) break;
    // also a state that is not taken: smoke and the age of marks depend on all
    std::string problem = camera.follow(frame);
    const bool taken = stamp.toSec() >= options.from && due.isDue(stamp) && turn++ % options.every == 0;
    if (problem.empty() && taken) {
      if (!folder) folder.emplace(options);
      problem = camera.take(frame, frames.poses(), *folder);
    }
    if (!problem.empty()) throw wrongState(options, stamp, problem);
    if (!taken) continue;
    world = frame.particles->header.frame_id;
    progress.show(frames, camera.images());
  }
  if (camera.images() == 0)
    throw std::runtime_error("'" + options.name + "' has no state between --from and --to; give other times.");
  folder->finish(frames.info(), camera.labels(), world);
  std::printf("%zu images in %s\n", camera.images(), options.output.c_str());
}

int runDataset(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is then an error like a full disk
  DatasetOptions options;
  const int status = readDatasetOptions(argc, argv, options);
  if (status >= 0) return status;
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_dataset: %s\n", error.what());
    return kFailure;
  }
  return 0;
}

}  // namespace
}  // namespace vibe::endoscope

int main(int argc, char** argv) {
  return vibe::endoscope::runDataset(argc, argv);
}
