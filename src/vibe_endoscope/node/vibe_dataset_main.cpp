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

#include "dataset_camera.hpp"
#include "image_due.hpp"
#include "robot_shapes.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/graphics/virtual_display.hpp"

namespace endoscope = vibe::endoscope;
namespace graphics = vibe::graphics;

namespace {

constexpr int kFailure = 1;
constexpr auto kProgressPeriod = std::chrono::seconds(2);

/// Prints how far it is, now and then.
class Progress {
 public:
  void show(const endoscope::SessionFrames& frames, std::size_t images) {
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

std::runtime_error wrongState(const endoscope::DatasetOptions& options, const ros::Time& stamp,
                              const std::string& problem) {
  const std::string what = problem.substr(0, problem.find(';'));  // then: what a display does about it
  return std::runtime_error("The state at " + timeText(stamp.toSec()) + " s of '" + options.name +
                            "' cannot be used; end before it with --to, or record again: " + what);
}

/// A part that is not there would be missing in image and truth.
void refuseMissingMeshes(const std::string& urdf, const std::string& recording) {
  std::vector<std::string> problems;
  endoscope::robotShapes(urdf, problems);
  if (!problems.empty())
    throw std::runtime_error("The instrument of '" + recording + "' cannot be shown whole: " + problems.front());
}

void run(const endoscope::DatasetOptions& options) {
  const std::string impossible = endoscope::problemOf(options.sensor, options.round);
  if (!impossible.empty())
    throw std::runtime_error("--seed " + std::to_string(options.seed) + " does not go with this lens: " + impossible +
                             ", or give another seed.");
  endoscope::SessionFrames frames(options.bag);
  if (options.from > frames.end())
    throw std::runtime_error("--from: '" + options.name + "' ends at " + timeText(frames.end()) +
                             " s; give a time before that.");
  refuseMissingMeshes(frames.info().urdf, options.name);
  if (options.check) return;
  std::optional<endoscope::DatasetFolder> folder;  // made with the first image, so that a refusal leaves nothing
  graphics::provideDisplay();
  rviz::RenderSystem::forceNoStereo();
  Ogre::SceneManager* scene = rviz::RenderSystem::get()->root()->createSceneManager();
  graphics::loadResources();
  endoscope::DatasetCamera camera(options, *scene, frames.info().urdf);
  endoscope::ImageDue due(options.rate);
  endoscope::SessionFrame frame;
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

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is then an error like a full disk
  endoscope::DatasetOptions options;
  const int status = endoscope::readDatasetOptions(argc, argv, options);
  if (status >= 0) return status;
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_dataset: %s\n", error.what());
    return kFailure;
  }
  return 0;
}
