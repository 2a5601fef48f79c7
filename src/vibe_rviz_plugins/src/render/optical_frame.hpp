#pragma once
#include <OgreQuaternion.h>

namespace vibe {

constexpr float kScopeNearClip = 0.0006f;  ///< what is nearer is not drawn; the lens' own glass is 0.4 mm thick [m]
constexpr float kScopeFarClip = 2;         ///< nothing in a body is farther [m]

/// Turns a camera of Ogre (z backward, x right, y up) so that it looks along an optical frame (z forward, x right,
/// y down): orientation of the camera = orientation of the frame * this.
inline Ogre::Quaternion opticalToOgre() {
  return {0, 1, 0, 0};
}

}  // namespace vibe
