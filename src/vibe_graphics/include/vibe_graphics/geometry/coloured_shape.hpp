#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vibe::graphics {

/// The part of a vertex that moves, in the layout of a vertex buffer.
struct MovingVertex {
  float position[3];  ///< [m]
  float normal[3];    ///< unit
};
static_assert(sizeof(MovingVertex) == 24, "the vertex buffer has no gaps");

/// Colour in the layout of a vertex buffer: red in the lowest byte, then green, blue, alpha.
using PackedColour = std::uint32_t;

/// @param red, green, blue, alpha  [0, 1], clamped
constexpr PackedColour packed(double red, double green, double blue, double alpha = 1) {
  const double channels[4] = {red, green, blue, alpha};
  PackedColour colour = 0;
  for (int k = 0; k < 4; ++k) {
    const double value = channels[k] < 0 ? 0 : channels[k] > 1 ? 1 : channels[k];
    colour |= static_cast<PackedColour>(255 * value + 0.5) << (8 * k);
  }
  return colour;
}

/// Triangles with vertices and colours. Shapes are appended, so that one mesh draws many.
struct ColouredShape {
  std::vector<MovingVertex> vertices;    ///< in any order; triangles refer to them by number
  std::vector<PackedColour> colours;     ///< one per vertex
  std::vector<std::uint32_t> triangles;  ///< three vertex numbers each, counter-clockwise seen from outside

  void clear() { vertices.clear(), colours.clear(), triangles.clear(); }
};

/// Why this shape cannot be drawn, as one sentence; empty: it can. Graphics libraries abort on such shapes.
std::string problemOf(const ColouredShape& shape);

/// Adds the triangles of a shape to those of another one.
void appendShape(const ColouredShape& from, ColouredShape& to);

/// Adds the triangles between two rows of vertices, given by the first of each.
/// @param closed  the last vertex of a row is beside the first
void joinRows(std::uint32_t upper, std::uint32_t lower, std::uint32_t count, bool closed, ColouredShape& shape);

}  // namespace vibe::graphics
