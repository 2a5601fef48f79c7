#pragma once

#include "protocol/message_kind.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::web {

/// Messages Kind::Blood and Kind::Threads: u8 kind, u8 0[3], u32 vertices, u32 corners, u32 colours, u32 points,
/// f32 lowest[3], f32 step[3], u16 place[3 vertices] and u16 point[3 points] as in a PlaceBox, i8 normal[3 vertices] in
/// 1/127; for each colour that follows another one u8 colour[4] and a whole number of vertices; for each corner its
/// difference from the one before as a whole number, 2 d or, below zero, -2 d - 1. Whole numbers have seven bits in
/// each byte, the lowest first, and all bytes but the last have the eighth. So a tube of thread takes a third of what
/// its numbers would.
/// @param points  inside of the shape, which a page may move it by: each vertex goes with the nearest one
Bytes encodeShape(Kind kind, const graphics::ColouredShape& shape, const std::vector<Eigen::Vector3d>& points = {});

}  // namespace vibe::web
