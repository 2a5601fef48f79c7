#pragma once
#include <random>
#include <string>

#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// A valid configuration with any numbers, for tests of properties.
class RandomConfig {
 public:
  explicit RandomConfig(unsigned seed) : random_(seed) {}

  VisionConfig make() {
    VisionConfig config;
    config.camera = camera();
    config.noise = {from(0.01, 1), from(0.1, 3)};
    config.blur = from(0.3, 3);
    config.gates = {from(5, 50), from(0.1, 0.9), from(0.05, 0.3), from(0.1, 0.7)};
    const int count = 1 + static_cast<int>(random_() % 4);
    for (int i = 0; i < count; ++i) config.instruments.push_back(instrument(std::to_string(i), config.camera));
    return config;
  }

 private:
  std::mt19937 random_;

  double from(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  CameraModel camera() {
    CameraModel camera;
    camera.width = 300 + static_cast<int>(random_() % 2000);
    camera.height = 300 + static_cast<int>(random_() % 1500);
    camera.fx = from(3000, 9000);
    camera.fy = from(3000, 9000);
    camera.cx = camera.width * from(0.4, 0.6);
    camera.cy = camera.height * from(0.4, 0.6);
    camera.distortion = {from(-0.1, 0.1), from(-0.1, 0.1), from(-1e-3, 1e-3), from(-1e-3, 1e-3), from(-0.1, 0.1)};
    camera.reprojection_rms = from(0, 1);
    return camera;
  }

  MarkerDesign marker() {
    if (random_() % 4 == 0)
      return TagDesign{random_() % 2 == 0 ? TagFamily::AprilTag : TagFamily::Aruco, static_cast<int>(random_() % 50),
                       from(1e-3, 1e-2)};
    if (random_() % 2 == 0) {
      const double outer = from(1e-3, 1e-2);
      return RingDesign{outer, outer * from(0.3, 0.7), outer * from(1.5, 2)};
    }
    SleeveDesign sleeve;
    const double size = from(0.5, 3) * 1e-3;
    sleeve.diameter = 3 * size;
    sleeve.length = 10 * size;
    sleeve.bars = {
        {-4.2 * size, -3.7 * size}, {-3.2 * size, -2.2 * size}, {2 * size, 2.5 * size}, {3.6 * size, 4.2 * size}};
    sleeve.helix_begin = -1.8 * size;
    sleeve.helix_end = 1.6 * size;
    sleeve.helix_pitch = from(2, 5) * (random_() % 2 == 0 ? size : -size);
    sleeve.helix_duty = from(0.2, 0.8);
    return sleeve;
  }

  SlideAxis axis(const CameraModel& camera) {
    SlideAxis axis;
    axis.origin = {camera.width * from(0, 1), camera.height * from(0, 1)};
    const double angle = from(-3, 3);
    axis.direction = {std::cos(angle), std::sin(angle)};
    axis.pixels_per_metre = from(2000, 50000);
    axis.perspective = from(-2, 2);
    axis.residual_rms = from(0, 1e-4);
    if (random_() % 2 == 0) return axis;
    const Eigen::Matrix<double, 5, 5> any = Eigen::Matrix<double, 5, 5>::NullaryExpr([this] { return from(-1, 1); });
    axis.covariance = any * any.transpose();
    axis.covariance.triangularView<Eigen::StrictlyLower>() = axis.covariance.transpose();
    return axis;
  }

  InstrumentConfig instrument(const std::string& suffix, const CameraModel& camera) {
    InstrumentConfig instrument;
    instrument.name = "tool \"" + suffix + "\": # \\";  // what YAML reads otherwise unless it is quoted
    instrument.marker = marker();
    instrument.axis = axis(camera);
    instrument.lower = from(-0.02, 0);
    instrument.upper = from(0.001, 0.03);
    instrument.lateral_tolerance = from(1e-4, 1e-3);
    instrument.ink = from(-5e-5, 5e-5);
    instrument.motion = {from(0.1, 2), from(1, 100), from(1, 100)};
    instrument.slide_joint = "slide" + suffix;
    instrument.slide_sign = random_() % 2 == 0 ? 1 : -1;
    instrument.slide_offset = from(-0.1, 0.1);
    if (std::holds_alternative<SleeveDesign>(instrument.marker) && random_() % 2 == 0) {
      instrument.rotation_joint = "rotation" + suffix;
      instrument.rotation_sign = random_() % 2 == 0 ? 1 : -1;
      instrument.rotation_offset = from(-3, 3);
    }
    return instrument;
  }
};

}  // namespace vibe::vision
