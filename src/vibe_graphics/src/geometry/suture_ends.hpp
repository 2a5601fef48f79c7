#pragma once

#include <Eigen/Core>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"

namespace vibe::graphics {

// Orientation of the parts of a suture from the positions of its bites and thread. All are unit vectors, rotate with
// the suture, and are defined for every set, even if all bites coincide.

/// Normal of the plane that fits the bites best; perpendicular to the line if they are collinear.
Eigen::Vector3d planeNormal(const SutureSet& set);

/// Axis of the ring at a bite: normal to the wall if its side is known, so that the ring lies flat on it; otherwise the
/// mean direction of the thread before and after.
Eigen::Vector3d biteAxis(const SutureSet& set, std::size_t bite);

/// Axis of the T-tag, which lies flat on the wall across the thread.
Eigen::Vector3d tagAxis(const SutureSet& set);

/// Axis of the cinch, along the thread.
Eigen::Vector3d cinchAxis(const SutureSet& set);

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

}  // namespace vibe::graphics
