#pragma once
#include <cstdint>

namespace vibe::rviz_plugins {

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

}  // namespace vibe::rviz_plugins
