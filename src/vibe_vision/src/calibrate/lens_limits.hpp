#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "vibe_vision/calibrate/lens_calibration.hpp"

namespace vibe::vision {

// Below these a calibration is doubtful: experience with chessboards, design choice.
constexpr std::size_t kEnoughViews = 8;
constexpr double kEnoughTilt = 15 * M_PI / 180;

/// Inner corners on the board [mm]. In metres, the equations are so badly scaled that OpenCV drops their weakest
/// direction, and with it most of the uncertainty of the focal length.
std::vector<cv::Point3f> boardPoints(const BoardSpec& board);

}  // namespace vibe::vision
