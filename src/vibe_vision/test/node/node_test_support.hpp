#pragma once
#include <cmath>
#include <vector>

#include "vision_messages.hpp"

namespace vibe::vision {

/// A sleeve and a ring, with joints that differ from what is measured by sign and offset.
inline VisionConfig twoInstruments() {
  VisionConfig config;
  config.camera.width = 728;
  config.camera.height = 544;
  config.camera.fx = 4600;
  config.camera.fy = 4601;
  config.camera.cx = 361;
  config.camera.cy = 274;
  config.camera.distortion = {0.06, -0.01, 0.001, 0.002, 0.003};
  config.instruments.resize(2);
  InstrumentConfig& helix = config.instruments[0];
  helix.name = "helix";
  helix.marker = defaultSleeve();
  helix.slide_joint = "helix_advance";
  helix.rotation_joint = "helix_rotation";
  helix.slide_sign = -1;
  helix.slide_offset = 0.1;
  helix.rotation_sign = -1;
  helix.rotation_offset = 2;
  helix.axis = {{360, 120}, {1, 0}, 10000, 0, 0};
  InstrumentConfig& driver = config.instruments[1];
  driver.name = "needle_driver";
  driver.marker = RingDesign();
  driver.slide_joint = "needle_driver";
  driver.axis = {{360, 300}, {1, 0}, 10000, 0, 0};
  for (InstrumentConfig& instrument : config.instruments) {
    instrument.lower = -0.02;
    instrument.upper = 0.02;
  }
  return config;
}

inline Measurement trackedMeasurement(double slide, double rotation) {
  Measurement measurement;
  measurement.reason = LostReason::None;
  measurement.slide = slide;
  measurement.rotation = rotation;
  measurement.covariance << 1e-12, 2e-10, 2e-10, 1e-6;
  measurement.score = 0.9;
  measurement.visible = 0.8;
  measurement.along_variance = 1e-4;
  measurement.pixel << 400.25, 120.5;
  measurement.scale = 1.01;
  measurement.roi_x = 370;
  measurement.roi_y = 100;
  measurement.roi_width = 60;
  measurement.roi_height = 40;
  return measurement;
}

inline Measurement lostMeasurement(LostReason reason) {
  Measurement measurement;
  measurement.reason = reason;
  measurement.slide = measurement.rotation = std::nan("");
  return measurement;
}

/// What the pipeline makes of measurements.
inline std::vector<JointSample> samplesOf(const VisionConfig& config, double time, const Measurements& measurements) {
  std::vector<JointSample> samples;
  for (std::size_t i = 0; i < measurements.size(); ++i)
    samples.push_back(InstrumentPredictor(config.instruments[i]).update(time, measurements[i]));
  return samples;
}

}  // namespace vibe::vision
