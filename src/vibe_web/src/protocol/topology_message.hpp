#pragma once

#include "protocol/message_kind.hpp"
#include "vibe_graphics/geometry/mucosa_map.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::web {

/// Message Kind::Topology, once per scene:
///   u8 kind, u8 0[3], u32 revision, u32 particles, u32 vertices, u32 particle triangles, u32 triangles, u32 weights,
///   u32 corner[3 particle triangles], u32 corner[3 triangles], u32 offset[vertices + 1], u32 particle[weights],
///   f32 weight[weights], f32 rest[3 vertices], f32 mucosa[8 vertices] (graphics::MucosaVertex).
/// Without a render surface the particles are the vertices, with one weight each.
Bytes encodeTopology(const graphics::TissueMesh& mesh, const graphics::MucosaMap& map);

}  // namespace vibe::web
