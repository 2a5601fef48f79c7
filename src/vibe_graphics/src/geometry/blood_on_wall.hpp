#pragma once
#include "vibe_graphics/geometry/blood_flow.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::graphics {

// The shapes of blood that lies on a wall. They follow the wall, a little above it; colour and opacity of a vertex are
// those of the depth of blood there, so that edges are thin and let the wall through.

/// A round film, at most 0.6 mm high.
void appendFilm(const BloodFilm& film, const WallSurface& wall, const BloodStyle& style, ColouredShape& shape);

/// A ribbon along the line with a round head; its middle meanders by up to 1 mm.
void appendRivulet(const Rivulet& rivulet, const WallSurface& wall, ColouredShape& shape);

/// The level surface of a pool: its triangles of the wall, cut at the level and raised to it. Normals tilt at the
/// shore, as those of a fluid that does not wet.
void appendPool(const Pool& pool, const WallSurface& wall, const BloodStyle& style, ColouredShape& shape);

}  // namespace vibe::graphics
