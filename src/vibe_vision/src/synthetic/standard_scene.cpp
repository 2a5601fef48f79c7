#include <cmath>
#include <utility>

#include "vibe_core/program/error.hpp"
#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision {
namespace {

constexpr double kPeakSpeed = 0.5;  // [m/s]
constexpr double kDegree = M_PI / 180;

/// 3.45 um pixels, a 16 mm lens, 0.46 m away: 0.1 mm/px.
CameraModel standardCamera() {
  CameraModel camera;
  camera.width = 728;
  camera.height = 544;
  camera.fx = camera.fy = 4600;
  camera.cx = 361.4;
  camera.cy = 274.2;
  return camera;
}

SlideAxis axisAt(double x, double y, double angle, double perspective) {
  SlideAxis axis;
  axis.origin = {x, y};
  axis.direction = {std::cos(angle), std::sin(angle)};
  axis.pixels_per_metre = 10000;
  axis.perspective = perspective;
  return axis;
}

/// A sine with the given peak speed.
std::function<double(double)> sineMotion(double amplitude, double peak_speed, double phase) {
  return [=](double time) { return amplitude * std::sin(peak_speed / amplitude * time + phase); };
}

SyntheticInstrument standardHelix() {
  SyntheticInstrument helix;
  helix.nominal.name = "helix";
  helix.nominal.marker = defaultSleeve();
  helix.nominal.axis = axisAt(363.7, 120.3, 0.5 * kDegree, 0.02);
  helix.nominal.lower = -0.027;
  helix.nominal.upper = 0.027;
  helix.nominal.slide_joint = "helix_advance";
  helix.nominal.rotation_joint = "helix_rotation";
  helix.motion.slide = sineMotion(0.025, kPeakSpeed, 0.3);
  helix.motion.rotation = sineMotion(2.5, 30, 1.1);
  helix.lateral = 1e-4;
  return helix;
}

SyntheticInstrument standardNeedleDriver() {
  SyntheticInstrument driver;
  driver.nominal.name = "needle_driver";
  driver.nominal.marker = RingDesign();
  driver.nominal.axis = axisAt(360.2, 240.6, -0.4 * kDegree, -0.03);
  driver.nominal.lower = -0.025;
  driver.nominal.upper = 0.025;
  driver.nominal.slide_joint = "needle_driver";
  driver.motion.slide = sineMotion(0.022, kPeakSpeed, 2.0);
  driver.motion.rotation = [](double) { return 0.0; };
  driver.lateral = -1.5e-4;
  return driver;
}

/// The instruments rest where the motion starts.
void hold(SyntheticScene& scene) {
  for (SyntheticInstrument& instrument : scene.instruments) {
    const double slide = instrument.motion.slide(0), rotation = instrument.motion.rotation(0);
    instrument.motion.slide = [slide](double) { return slide; };
    instrument.motion.rotation = [rotation](double) { return rotation; };
  }
}

/// A lens that moves the corners by 6 % of their distance from the centre.
void bendLens(SyntheticScene& scene) {
  const CameraModel& camera = scene.camera;
  const double corner = std::hypot(camera.width / 2.0, camera.height / 2.0) / camera.fx;
  scene.degradation.distortion = {-0.06 / (corner * corner), 0, 2e-3, -1e-3, 0};
  scene.camera.distortion = scene.degradation.distortion;
}

void spoilLight(SyntheticScene& scene) {
  scene.degradation.flicker = 0.12;
  scene.degradation.drift = 0.2;
  scene.degradation.vignetting = 0.3;
  bendLens(scene);
}

void tilt(SyntheticScene& scene) {
  double sign = 1;
  for (SyntheticInstrument& instrument : scene.instruments) {
    instrument.tilt = sign * 15 * kDegree;
    instrument.slant = -sign * 15 * kDegree;
    sign = -sign;
  }
}

void rescale(SyntheticScene& scene) {
  double sign = 1;
  for (SyntheticInstrument& instrument : scene.instruments) {
    instrument.scale = 1 + 0.1 * sign;
    sign = -sign;
  }
}

void spoilEverything(SyntheticScene& scene) {
  spoilLight(scene);
  scene.degradation.blur = 1;
  scene.degradation.noise.gain = 0.096 * std::pow(10, (24.0 - 12.0) / 20);  // 24 dB instead of 12
  scene.degradation.noise.read = 0.6 * std::pow(10, (24.0 - 12.0) / 20);
  scene.degradation.highlights = 2;
  scene.degradation.occluder = true;
  scene.degradation.look_alike = true;
}

using Change = void (*)(SyntheticScene&);
const std::vector<std::pair<std::string, Change>>& changes() {
  static const std::vector<std::pair<std::string, Change>> all = {
      {"static", hold},
      {"moving", [](SyntheticScene&) {}},
      {"long_exposure", [](SyntheticScene& scene) { scene.degradation.exposure = 4e-3; }},
      {"defocus", [](SyntheticScene& scene) { scene.degradation.blur = 2; }},
      {"light", spoilLight},
      {"highlights", [](SyntheticScene& scene) { scene.degradation.highlights = 2; }},
      {"occluder", [](SyntheticScene& scene) { scene.degradation.occluder = true; }},
      {"look_alike", [](SyntheticScene& scene) { scene.degradation.look_alike = true; }},
      {"all", spoilEverything},
      {"tilt", tilt},
      {"scale", rescale}};
  return all;
}

}  // namespace

VisionConfig nominalConfig(const SyntheticScene& scene) {
  VisionConfig config;
  config.camera = scene.camera;
  config.noise = scene.degradation.noise;
  for (const SyntheticInstrument& instrument : scene.instruments) config.instruments.push_back(instrument.nominal);
  return config;
}

SyntheticScene standardScene() {
  SyntheticScene scene;
  scene.camera = standardCamera();
  scene.instruments = {standardHelix(), standardNeedleDriver()};
  return scene;
}

SyntheticScene blinkScene(double jump) {
  SyntheticScene scene = standardScene();
  hold(scene);
  const double before = 0.5 / scene.rate;
  scene.instruments[0].motion.slide = [=](double time) { return time < before ? kBlinkSlide : kBlinkSlide + jump; };
  scene.instruments[0].motion.rotation = [](double) { return 0.0; };
  return scene;
}

SyntheticScene swayScene() {
  SyntheticScene scene = standardScene();
  hold(scene);
  scene.instruments[0].motion.slide = [](double time) {
    return kSwayMiddle - kSwayAmplitude * std::cos(2 * M_PI * kSwayRate * time);
  };
  scene.instruments[0].motion.rotation = [](double) { return 0.0; };
  return scene;
}

SyntheticScene namedScene(const std::string& name) {
  std::string names;
  for (const auto& [known, change] : changes()) {
    names += (names.empty() ? "" : ", ") + known;
    if (known != name) continue;
    SyntheticScene scene = standardScene();
    change(scene);
    return scene;
  }
  throw Error("synthetic scene '" + name + "' is not known; there are " + names + ".");
}

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const auto& change : changes()) names.push_back(change.first);
  return names;
}

}  // namespace vibe::vision
