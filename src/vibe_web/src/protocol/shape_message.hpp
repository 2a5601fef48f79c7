#pragma once

#include "protocol/message_kind.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::web {

/// Messages Kind::Blood and Kind::Threads: u8 kind, u8 0[3], u32 vertices, u32 triangles, f32 place[3 vertices] [m],
/// u32 corner[3 triangles], u8 colour[4 vertices], i8 normal[4 vertices] in 1/127 (the fourth is 0).
Bytes encodeShape(Kind kind, const graphics::ColouredShape& shape);

}  // namespace vibe::web
