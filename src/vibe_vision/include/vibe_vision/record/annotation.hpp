#pragma once
#include <opencv2/core.hpp>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/track/measurement.hpp"

namespace vibe {

/// The frame in colour, with axes, crosses on the markers, and slide, rotation or the reason of the loss as text.
cv::Mat annotate(const VisionConfig& config, const Frame& frame, const Measurements& measurements);

}  // namespace vibe
