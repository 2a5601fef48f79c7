#include <atomic>
#include <chrono>
#include <csignal>
#include <iostream>
#include <random>
#include <thread>
#include <vector>

#include "program_options.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/camera/fake_camera.hpp"

namespace vision = vibe::vision;

namespace {

std::atomic<bool> shall_stop{false};

// scenes of its own: the helix jumps at random times, or goes to and fro
const std::string kBlink = "blink", kSway = "sway";

struct Options {
  std::string scene = "moving", config;
  int frames = 300;
  double duration = 0;
  int blinks = 1000;
  double blink_after = 5, blink_jump = 1e-4;
  std::uint64_t seed = 1;
  vision::FakeCameraOptions camera;
};

void writeConfig(const std::string& file, const vision::SyntheticScene& scene) {
  vibe::writeFile(file, vision::toYaml(vision::nominalConfig(scene)), "The configuration");
}

constexpr double kShortestBlink = 0.25, kLongestBlink = 0.5;  // between two [s]

/// Unix times, random so that their phase against every clock is uniform [s].
std::vector<double> blinkTimes(const Options& options) {
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> interval(kShortestBlink, kLongestBlink);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  double time = std::chrono::duration<double>(now).count() + options.blink_after;
  std::vector<double> times;
  for (int i = 0; i < options.blinks; ++i) times.push_back(time += interval(random));
  return times;
}

vision::SyntheticScene sceneOf(const Options& options) {
  if (options.scene == kBlink) return vision::blinkScene(options.blink_jump);
  if (options.scene == kSway) return vision::swayScene();
  return vision::namedScene(options.scene);
}

void serve(Options options) {
  const bool blinks = options.scene == kBlink;
  if (!blinks && !options.camera.blink_file.empty()) throw vibe::Error("--blink-log goes with --scene blink; add it.");
  const vision::SyntheticScene scene = sceneOf(options);
  if (blinks) options.frames = 2;
  if (options.scene == kSway) options.frames = vision::kSwayFrames;
  if (!options.config.empty()) writeConfig(options.config, scene);
  std::cout << "vibe_fake_camera: draws " << options.scene << " ..." << std::endl;
  const auto ring = vision::renderRing(scene, options.frames);
  if (blinks) options.camera.blinks = blinkTimes(options);
  const vision::FakeCamera camera(ring, options.camera);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { shall_stop = true; });
  std::cout << "vibe_fake_camera: gige:" << options.camera.address << " serves " << options.scene << ", "
            << scene.camera.width << " x " << scene.camera.height << " at " << scene.rate << " Hz; end with Ctrl-C"
            << std::endl;
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto isOver = [&] {
    return options.duration > 0 && Clock::now() - begin > std::chrono::duration<double>(options.duration);
  };
  while (!shall_stop && !isOver()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::cout << "vibe_fake_camera: " << camera.sent() << " frames sent" << std::endl;
}

void addBlinkOptions(vibe::OptionList& line, Options& options) {
  line.option("--blinks", options.blinks, "of the scene blink: how often the helix jumps")
      .check(vibe::inRange(1, 1000000))
      .showDefault();
  line.option("--blink-after", options.blink_after, "time before the first jump [s]")
      .check(vibe::finiteIn(0, 1e6))
      .showDefault();
  line.option("--blink-jump", options.blink_jump, "by how much it jumps [m]")
      .check(vibe::finiteIn(-0.02, 0.02))
      .showDefault();
  line.option("--blink-log", options.camera.blink_file, "file for when each jump happened and was exposed");
  line.option("--seed", options.seed, "of the times of the jumps").showDefault();
}

void addOptions(vibe::OptionList& line, Options& options) {
  std::string names = kBlink + ", " + kSway;
  for (const std::string& name : vision::sceneNames()) names += ", " + name;
  line.option("--scene", options.scene, "one of " + names).showDefault();
  line.option("--address", options.camera.address, "of a network interface of this computer").showDefault();
  line.option("--serial", options.camera.serial, "serial number").showDefault();
  line.option("--frames", options.frames, "drawn at most; 0.4 MB of memory each")
      .check(vibe::inRange(2, 5000))
      .showDefault();
  line.option("--truth", options.camera.truth_file,
              "file for slide [m], rotation [rad] and places [px] of each frame sent, as truth.csv of vibe_render");
  addBlinkOptions(line, options);
  line.option("--config", options.config, "file for the configuration of the scene, for the tracker");
  line.option("--lost-ratio", options.camera.lost_ratio, "share of the packets that are not sent")
      .check(vibe::finiteIn(0, 1))
      .showDefault();
  line.option("--clock-ahead", options.camera.clock_ahead, "camera's clock less Unix time [s]")
      .check(vibe::finiteIn(-1e9, 1e9))
      .showDefault();
  line.option("--clock-drift", options.camera.clock_drift, "by which the camera's clock is fast, such as 2e-5")
      .check(vibe::finiteIn(-1e-2, 1e-2))
      .showDefault();
  line.option("--duration", options.duration, "time after which it ends [s]; 0: runs until it is stopped")
      .check(vibe::finiteIn(0, 1e6))
      .showDefault();
}

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line(
      "A GigE Vision camera in software: it draws a synthetic scene once and serves it over the network, so that the\n"
      "whole way from packets to positions runs without a camera. Consumers open it as gige:ADDRESS. It shows the\n"
      "drawn frames forward and backward in turn.",
      "vibe_fake_camera");
  Options options;
  addOptions(line, options);
  return vibe::runProgram(line, argc, argv, [&options] {
    serve(options);
    return 0;
  });
}
