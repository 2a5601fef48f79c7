#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::rviz_plugins {
namespace {

constexpr float kMaxCoordinate = 1e6F;  // a vertex farther away is a mistake [m]

// Written so that NaN is out of range too.
bool isInRange(const MovingVertex& vertex) {
  return std::all_of(std::begin(vertex.position), std::end(vertex.position),
                     [](float x) { return std::abs(x) < kMaxCoordinate; }) &&
         std::all_of(std::begin(vertex.normal), std::end(vertex.normal), [](float x) { return std::isfinite(x); });
}

}  // namespace

std::string problemOf(const ColouredShape& shape) {
  const std::size_t count = shape.vertices.size();
  if (shape.colours.size() != count)
    return "The shape has " + std::to_string(count) + " vertices and " + std::to_string(shape.colours.size()) +
           " colours.";
  if (shape.triangles.size() % 3 != 0) return "The shape has an incomplete triangle.";
  for (std::size_t v = 0; v < count; ++v)
    if (!isInRange(shape.vertices[v]))
      return "Vertex " + std::to_string(v) + " of the shape is not finite or farther away than 1000 km.";
  for (const std::uint32_t corner : shape.triangles)
    if (corner >= count)
      return "A triangle of the shape refers to vertex " + std::to_string(corner) + " of " + std::to_string(count) +
             ".";
  return "";
}

}  // namespace vibe::rviz_plugins
