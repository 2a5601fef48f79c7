// What an image of the endoscope costs with all of its truth: CPU time of the process, by part, at chosen states of a
// recorded session. scripts/bench_camera makes the recording. Needs no ROS master and no display.
#include <OgreRenderSystem.h>
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <rviz/ogre_helpers/render_system.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "endoscope_scene.hpp"
#include "session_frames.hpp"
#include "truth/truth_camera.hpp"
#include "truth_world.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/graphics/virtual_display.hpp"

namespace {

using namespace vibe;
using namespace vibe::endoscope;

constexpr int kWarmUp = 5, kImages = 40;
constexpr double kGoal = 150;  // for an image of 640 x 480 with all of its truth [ms]

enum Part { Motion, Colour, TruthMotion, Flow, Rays, Depth, Normals, Labels, Truth, Whole, kPartCount };
constexpr std::array<const char*, kPartCount> kPartNames{"motion of the picture",
                                                         "colour",
                                                         "motion of the truth",
                                                         "flow",
                                                         "rays",
                                                         "depth",
                                                         "normals",
                                                         "labels",
                                                         "truth",
                                                         "all"};
using Samples = std::array<std::vector<double>, kPartCount>;  // [ms]

/// Time that all threads of this process together have had of a processor [s]: other programs on the machine lengthen
/// it little.
double processTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A state with the poses of all frames then.
struct Moment {
  SessionFrame frame;
  JointTree poses;
};

/// The two states that follow a time, because points flow from one to the other.
std::array<Moment, 2> momentsAfter(SessionFrames& frames, double seconds) {
  std::vector<Moment> found;
  for (SessionFrame frame; found.size() < 2 && frames.next(frame);)
    if (frame.particles->header.stamp.toSec() >= seconds) found.push_back({frame, frames.poses()});
  if (found.size() < 2) throw std::runtime_error("the recording ends before " + std::to_string(seconds) + " s");
  return {found[0], found[1]};
}

/// Camera, picture and truth of one state after the other, with a look at the clock between the parts.
class Bench {
 public:
  Bench(Ogre::SceneManager& scene, const std::string& urdf)
      : drawn_(scene, urdf, true),
        truth_(urdf),
        camera_(scene, {}, 1),
        truth_camera_({}, static_cast<double>(graphics::kScopeNearClip), static_cast<double>(graphics::kScopeFarClip)) {
  }

  void setTopology(const vibe_msgs::TissueTopology& topology) {
    check(drawn_.setTopology(topology)), check(truth_.setTopology(topology));
  }

  std::array<double, kPartCount> takeImage(const Moment& moment) {
    times_.fill(0);
    last_ = processTime();
    const EndoscopeScene::PoseOf pose_of = [&](const std::string& name) {
      return moment.poses.pose(name, moment.frame.particles->header.frame_id);
    };
    const Eigen::Isometry3d pose = pose_of("scope_camera_optical").value();
    check(drawn_.setParticles(*moment.frame.particles));
    drawn_.placeInstrument(pose_of);
    lap(Motion);
    camera_.take(pose, moment.frame.particles->header.stamp.toSec(), pixels_);
    lap(Colour);
    check(truth_.setParticles(*moment.frame.particles));
    truth_.placeInstrument(pose_of);
    truth_.commit();
    lap(TruthMotion);
    measureTruth(pose);
    for (int part = TruthMotion; part <= Labels; ++part) times_[Truth] += times_[static_cast<std::size_t>(part)];
    times_[Whole] = times_[Motion] + times_[Colour] + times_[Truth];
    return times_;
  }

 private:
  void measureTruth(const Eigen::Isometry3d& pose) {
    const TruthScene& scene = truth_.scene();
    if (before_.hits.empty()) truth_camera_.look(scene, pose, before_);
    truth_camera_.flow(before_, scene, pose);
    lap(Flow);
    truth_camera_.look(scene, pose, before_);
    lap(Rays);
    truth_camera_.depth(scene, before_);
    lap(Depth);
    truth_camera_.normals(scene, before_);
    lap(Normals);
    truth_camera_.labels(scene, before_);
    lap(Labels);
  }
  void lap(Part part) {
    const double now = processTime();
    times_[part] += 1e3 * (now - last_);
    last_ = now;
  }
  static void check(const std::string& problem) {
    if (!problem.empty()) throw std::runtime_error(problem);
  }

  EndoscopeScene drawn_;
  TruthWorld truth_;
  graphics::OffscreenCamera camera_;
  TruthCamera truth_camera_;
  TruthView before_;
  std::vector<std::uint8_t> pixels_;
  std::array<double, kPartCount> times_{};
  double last_ = 0;
};

Samples measure(Bench& bench, const std::array<Moment, 2>& moments) {
  Samples samples;
  for (int image = 0; image < kWarmUp + kImages; ++image) {
    const auto times = bench.takeImage(moments[static_cast<std::size_t>(image % 2)]);
    for (std::size_t part = 0; part < kPartCount && image >= kWarmUp; ++part) samples[part].push_back(times[part]);
  }
  for (auto& values : samples) std::sort(values.begin(), values.end());
  return samples;
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

int run(const std::string& bag, const std::vector<double>& times) {
  SessionFrames frames(bag);
  graphics::provideDisplay();
  rviz::RenderSystem::forceNoStereo();
  Ogre::SceneManager* scene = rviz::RenderSystem::get()->root()->createSceneManager();
  graphics::loadResources();
  Bench bench(*scene, frames.info().urdf);
  std::vector<Samples> columns;
  vibe_msgs::TissueTopology::ConstPtr topology;
  for (const double time : times) {
    const std::array<Moment, 2> moments = momentsAfter(frames, time);
    if (moments[0].frame.topology != topology) bench.setTopology(*(topology = moments[0].frame.topology));
    columns.push_back(measure(bench, moments));
  }
  std::printf("%s, %s; 640x480, %d images; CPU time of the process per image [ms], median (least)\n\n|",
              processorName().c_str(),
              Ogre::Root::getSingleton().getRenderSystem()->getCapabilities()->getDeviceName().c_str(), kImages);
  for (const double time : times) std::printf(" | at %.1f s", time);
  std::printf(" |\n|---|");
  for (std::size_t k = 0; k < times.size(); ++k) std::printf("---|");
  for (std::size_t part = 0; part < kPartCount; ++part) {
    std::printf("\n| %s |", kPartNames[part]);
    for (const Samples& samples : columns)
      std::printf(" %.1f (%.1f) |", samples[part][kImages / 2], samples[part].front());
  }
  double worst = 0;
  for (const Samples& samples : columns) worst = std::max(worst, samples[Whole][kImages / 2]);
  std::printf("\n\n%.1f ms at most, goal %.0f ms: %s\n", worst, kGoal, worst <= kGoal ? "met" : "missed");
  return worst <= kGoal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> times;
  try {
    for (int k = 2; k < argc; ++k) times.push_back(std::stod(argv[k]));
    if (times.empty()) throw std::runtime_error("give a whole recording and times in it [s]; see scripts/bench_camera");
    return run(argv[1], times);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_camera_bench: %s\n", error.what());
    return 2;
  }
}
