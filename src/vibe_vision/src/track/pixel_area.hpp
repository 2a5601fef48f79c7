#pragma once

namespace vibe::vision {

/// Of the area of a pixel [px^2].
constexpr double kPixelVariance = 1.0 / 12;

}  // namespace vibe::vision
