#include "protocol/shape_message.hpp"

#include <cmath>

#include "protocol/byte_writer.hpp"

namespace vibe::web {

Bytes encodeShape(Kind kind, const graphics::ColouredShape& shape) {
  const std::size_t count = shape.vertices.size();
  ByteWriter writer(kind, 12 + 20 * count + 4 * shape.triangles.size());
  for (int k = 0; k < 3; ++k) writer.put(std::uint8_t{0});
  writer.put(static_cast<std::uint32_t>(count));
  writer.put(static_cast<std::uint32_t>(shape.triangles.size() / 3));
  for (const graphics::MovingVertex& vertex : shape.vertices) writer.putAll(vertex.position, 3);
  writer.putAll(shape.triangles.data(), shape.triangles.size());
  writer.putAll(shape.colours.data(), count);
  for (const graphics::MovingVertex& vertex : shape.vertices) {
    for (const float component : vertex.normal) writer.put(static_cast<std::int8_t>(std::lround(127 * component)));
    writer.put(std::int8_t{0});
  }
  return writer.take();
}

}  // namespace vibe::web
