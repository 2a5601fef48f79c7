#pragma once

namespace vibe {

/// A position beyond it is a mistake [m]. Graphics libraries abort on bounding boxes that are not finite.
constexpr double kMaxCoordinate = 1e6;

}  // namespace vibe
