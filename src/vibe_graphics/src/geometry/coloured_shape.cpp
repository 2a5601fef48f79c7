#include "vibe_graphics/geometry/coloured_shape.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::graphics {

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

void appendShape(const ColouredShape& from, ColouredShape& to) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  to.colours.insert(to.colours.end(), from.colours.begin(), from.colours.end());
  for (const std::uint32_t corner : from.triangles) to.triangles.push_back(first + corner);
}

void joinRows(std::uint32_t upper, std::uint32_t lower, std::uint32_t count, bool closed, ColouredShape& shape) {
  for (std::uint32_t k = 0; k < (closed ? count : count - 1); ++k) {
    const std::uint32_t next = (k + 1) % count;
    shape.triangles.insert(shape.triangles.end(), {upper + k, lower + k, lower + next});
    shape.triangles.insert(shape.triangles.end(), {upper + k, lower + next, upper + next});
  }
}

}  // namespace vibe::graphics
