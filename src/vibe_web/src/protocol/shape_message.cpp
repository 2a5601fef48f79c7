#include "protocol/shape_message.hpp"

#include <cmath>

#include "protocol/byte_writer.hpp"
#include "protocol/place_box.hpp"

namespace vibe::web {

namespace {

void putWhole(ByteWriter& writer, std::uint32_t number) {
  for (; number >= 0x80; number >>= 7) writer.put(static_cast<std::uint8_t>(number | 0x80));
  writer.put(static_cast<std::uint8_t>(number));
}

struct Run {
  graphics::PackedColour colour;
  std::uint32_t vertices;
};

std::vector<Run> runsOf(const std::vector<graphics::PackedColour>& colours) {
  std::vector<Run> runs;
  for (const graphics::PackedColour colour : colours) {
    if (runs.empty() || runs.back().colour != colour) runs.push_back({colour, 0});
    ++runs.back().vertices;
  }
  return runs;
}

void putCorners(ByteWriter& writer, const std::vector<std::uint32_t>& corners) {
  std::int32_t last = 0;
  for (const std::uint32_t corner : corners) {
    const std::int32_t d = static_cast<std::int32_t>(corner) - last;
    putWhole(writer, static_cast<std::uint32_t>(d < 0 ? -2 * d - 1 : 2 * d));
    last = static_cast<std::int32_t>(corner);
  }
}

}  // namespace

Bytes encodeShape(Kind kind, const graphics::ColouredShape& shape, const std::vector<Eigen::Vector3d>& points) {
  const std::size_t count = shape.vertices.size();
  const PlaceBox box(count, [&](std::size_t i) { return shape.vertices[i].position; });
  const std::vector<Run> runs = runsOf(shape.colours);
  ByteWriter writer(kind, 44 + 9 * count + 6 * points.size() + 6 * runs.size() + 2 * shape.triangles.size());
  for (int k = 0; k < 3; ++k) writer.put(std::uint8_t{0});
  for (const std::size_t number : {count, shape.triangles.size(), runs.size(), points.size()})
    writer.put(static_cast<std::uint32_t>(number));
  writer.putAll(box.lowest.data(), 3);
  writer.putAll(box.step.data(), 3);
  for (const graphics::MovingVertex& vertex : shape.vertices)
    for (std::size_t k = 0; k < 3; ++k) writer.put(box.place(vertex.position[k], k));
  for (const Eigen::Vector3d& point : points)
    for (std::size_t k = 0; k < 3; ++k) writer.put(box.place(static_cast<float>(point[static_cast<int>(k)]), k));
  for (const graphics::MovingVertex& vertex : shape.vertices)
    for (const float component : vertex.normal) writer.put(static_cast<std::int8_t>(std::lround(127 * component)));
  for (const Run& run : runs) {
    writer.put(run.colour);
    putWhole(writer, run.vertices);
  }
  putCorners(writer, shape.triangles);
  return writer.take();
}

}  // namespace vibe::web
