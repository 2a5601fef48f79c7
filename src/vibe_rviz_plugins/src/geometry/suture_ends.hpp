#pragma once
#include "geometry/suture_drawing.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

/// Opacity of vertices of metal, which media/suture.frag tells from polymer by it; bodies are drawn opaque.
constexpr double kMetal = 0.5;

constexpr int kThreadSides = 8;  ///< of the tube that is a thread

/// The thread that an implant holds.
struct HeldThread {
  PackedColour colour;
  double radius;  ///< [m]
};

/// Appends the T-tag of a set: a pin of metal, 6.5 mm x 0.9 mm, with a point and a chamfered end. It lies on the wall
/// across the thread, which is wound and knotted in a groove at its middle.
/// @param size  factor of its thickness; the length grows with its root
void appendTag(const SutureSet& set, double size, const HeldThread& thread, ColouredShape& shape);

/// Appends the cinch of a set: a cylinder of polymer, 6 mm x 1.9 mm, with a collar of 2.6 mm and a bore along the
/// thread, the cut end of which stands out.
void appendCinch(const SutureSet& set, double size, const HeldThread& thread, ColouredShape& shape);

}  // namespace vibe::rviz_plugins
