#pragma once

#include "protocol/command.hpp"
#include "protocol/message_kind.hpp"

namespace vibe::web {

/// Message Kind::Viewer, little-endian: u8 kind, u8 which are there (1 head, 2 left hand, 4 right hand), u16 0,
/// f32 pose[3][7] as in the command.
Bytes encodeViewer(const ViewerState& viewer);

}  // namespace vibe::web
