#pragma once

#include "protocol/message_kind.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"

namespace vibe::web {

/// Message Kind::Sutures; every number is an f32 but the kind, which stands in the first of four bytes. Lengths in
/// metres, in the frame of the drawing:
///   kind; sets, wounds;
///   for each set: stage (graphics::SutureStage), T-tag 1 or 0, its x y z, cinch 1 or 0, its x y z, bites, pieces;
///     for each bite: x y z, full thickness 1 or 0;  for each piece: tension [N], points, x y z of each point;
///   for each wound: x y z, x y z of the direction into the lumen, brisk 1 or 0, rate [mL/s], amount [mL], age [s].
Bytes encodeSutures(const graphics::SutureDrawing& drawing);

}  // namespace vibe::web
