#pragma once
#include <opencv2/core.hpp>

#include <string>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// The frame in colour. For each instrument: its axis, a box where it was looked for, a cross on its marker, and its
/// text; green if it is tracked, red if it is lost.
/// @param texts one per instrument
cv::Mat annotate(const VisionConfig& config, const Frame& frame, const Measurements& measurements,
                 const std::vector<std::string>& texts);

/// The same with slide and rotation, or the reason of the loss, as text.
cv::Mat annotate(const VisionConfig& config, const Frame& frame, const Measurements& measurements);

}  // namespace vibe::vision
