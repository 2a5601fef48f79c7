#pragma once

#include "vibe_core/geometry/anatomy.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Whether the scene fixes the particles of this end.
inline bool isHeld(const Scene& scene, End end) {
  return (end == End::Oesophagus && scene.attach_oesophagus) || (end == End::Duodenum && scene.attach_duodenum);
}

}  // namespace vibe
