#pragma once

namespace vibe::rviz_plugins {

/// A position beyond it is a mistake [m]. Graphics libraries abort on bounding boxes that are not finite.
constexpr double kMaxCoordinate = 1e6;

}  // namespace vibe::rviz_plugins
