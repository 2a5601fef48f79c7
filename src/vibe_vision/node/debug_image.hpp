#pragma once
#include <opencv2/core.hpp>

#include <vector>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/predict/instrument_predictor.hpp"
#include "vibe_vision/track/measurement.hpp"

namespace vibe::vision {

/// The frame in colour with, for each instrument, its axis, where it was looked for, where its marker is, and its
/// joints; red and with the reason if it is lost.
cv::Mat drawDebugImage(const VisionConfig& config, const Frame& frame, const Measurements& measurements,
                       const std::vector<JointSample>& samples);

}  // namespace vibe::vision
