#pragma once
#include <string>

namespace vibe::vision {

/// What keeps a file from being used as a V4L2 camera, with the remedy; empty if nothing does.
std::string v4l2Obstacle(const std::string& device);

}  // namespace vibe::vision
