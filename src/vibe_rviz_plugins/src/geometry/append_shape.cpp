#include "geometry/append_shape.hpp"

namespace vibe {

void appendShape(const ColouredShape& from, ColouredShape& to) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  to.colours.insert(to.colours.end(), from.colours.begin(), from.colours.end());
  for (const std::uint32_t corner : from.triangles) to.triangles.push_back(first + corner);
}

}  // namespace vibe
