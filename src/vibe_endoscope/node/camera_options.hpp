#pragma once
#include <ros/node_handle.h>

#include <string>

#include "sensor/sensor_model.hpp"
#include "vibe_graphics/geometry/endoscope_optics.hpp"

namespace vibe::endoscope {

/// Parameters of endoscope_camera.
struct CameraOptions {
  graphics::RoundCamera round;
  double sharpness = 1;  ///< as in sourceFor()
  double rate = 30;      ///< images per second of the stamps [Hz]; 0: one for every message of tissue/particles
  bool auto_exposure = true;
  bool smoke = true;  ///< whether the argon beam makes smoke
  bool stereo = false;
  double baseline = 0.004;                            ///< from the left lens to the right one [m]
  std::string camera_frame = "scope_camera_optical";  ///< where the camera is, the left one of a pair
  std::string frame_id, right_frame_id;               ///< in the headers; default: camera_frame
  SensorStyle sensor;                                 ///< of the image; the truth is not touched
};

/// @param node  its private parameters are read
/// @throws std::runtime_error  one is unknown, of the wrong type or out of range, in one sentence
CameraOptions readCameraOptions(const ros::NodeHandle& node);

}  // namespace vibe::endoscope
