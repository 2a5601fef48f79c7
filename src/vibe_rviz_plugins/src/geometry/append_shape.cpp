#include "geometry/append_shape.hpp"

namespace vibe::rviz_plugins {

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

}  // namespace vibe::rviz_plugins
