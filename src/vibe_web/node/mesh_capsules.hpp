#pragma once

#include <string>
#include <vector>

#include "vibe_graphics/geometry/capsule_fit.hpp"

namespace vibe::web {

/// What a mesh file is to the shadows that the device casts on the wall (graphics::fitCapsules), in the frame of the
/// file; empty if it cannot be read.
std::vector<graphics::Capsule> meshCapsules(const std::string& file);

}  // namespace vibe::web
