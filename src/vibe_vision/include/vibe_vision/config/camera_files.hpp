#pragma once

#include <string>

#include "vibe_vision/image/camera_model.hpp"

namespace vibe::vision {

/// Whose file a lens calibration is.
enum class CameraFileFormat {
  Ros,    ///< camera_info of camera_calibration and camera_info_manager: "plumb_bob"
  Kalibr  ///< camchain: "pinhole" with "radtan"; it has no k3
};

/// Reads a lens calibration of either format; which one it is shows from its keys.
/// @param camera  of a camchain with several ones, "cam1" for example; empty: the only one
/// @return without a residual of the calibration, which these files do not have
/// @throws Error with file, line and remedy, also for a lens model that is none of these two
CameraModel loadCameraFile(const std::string& file, const std::string& camera = "");

/// The camera as text of a file of that format; all numbers read back to the same bits.
/// @throws Error if the format cannot say it: k3 for Kalibr
std::string toCameraFile(const CameraModel& camera, CameraFileFormat format);

}  // namespace vibe::vision
