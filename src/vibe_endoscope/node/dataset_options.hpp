#pragma once
#include <limits>
#include <string>

#include "sensor/sensor_model.hpp"
#include "vibe_graphics/geometry/endoscope_optics.hpp"
#include "vibe_graphics/geometry/mucosa_pattern.hpp"

namespace vibe::endoscope {

/// Options of vibe_dataset.
struct DatasetOptions {
  bool check = false;  ///< only the options
  std::string bag;     ///< a whole recording
  std::string name;    ///< of the recording that it was made from, for the data sheet
  std::string output;  ///< folder; created, must be empty
  graphics::RoundCamera round;
  bool stereo = false;
  double baseline = 0.004;  ///< [m]
  double rate = 10;         ///< images per second of simulated time [Hz]; 0: every state
  int every = 1;            ///< of the images that `rate` gives, one in this many
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< [s]
  bool smoke = true;                                              ///< whether the argon beam makes smoke
  int seed = 0;                                                   ///< of the variation; 0: none
  bool vary_lens = true, vary_sensor = true, vary_mucosa = true, vary_light = true;  ///< with a seed
  bool depth = true, normals = true, labels = true, flow = true, particles = false, sutures = false;
  SensorStyle sensor;                   ///< as varied
  double roll = 0, pitch = 0, yaw = 0;  ///< of the lens in its mount, as varied [rad]
  graphics::MucosaLook mucosa;          ///< as varied
  graphics::EndoscopeLight light;       ///< as varied
};

/// @return the status with which the program ends at once: help was asked for, or the call is wrong; -1: go on
int readDatasetOptions(int argc, char** argv, DatasetOptions& options);

}  // namespace vibe::endoscope
