#pragma once
#include <OgreQuaternion.h>

namespace vibe::rviz_plugins {

constexpr float kScopeNearClip = 0.0006f;  ///< near clipping distance; the glass of the lens is 0.4 mm thick [m]
constexpr float kScopeFarClip = 2;         ///< far clipping distance, beyond any tissue [m]

/// Turns a camera of Ogre (z backward, x right, y up) so that it looks along an optical frame (z forward, x right,
/// y down): orientation of the camera = orientation of the frame * this.
inline Ogre::Quaternion opticalToOgre() {
  return {0, 1, 0, 0};
}

}  // namespace vibe::rviz_plugins
