#include "protocol/shape_message.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace vibe::web::shape_message_test {
namespace {

std::uint32_t whole(const std::uint8_t*& at) {
  std::uint32_t number = 0;
  for (int shift = 0;; shift += 7) {
    number |= static_cast<std::uint32_t>(*at & 0x7F) << shift;
    if ((*at++ & 0x80) == 0) return number;
  }
}

/// A thread of 200 rings of eight vertices, half of it in another colour.
graphics::ColouredShape tube() {
  graphics::ColouredShape shape;
  for (std::uint32_t v = 0; v < 1600; ++v) {
    const auto ring = static_cast<float>(v / 8), angle = 0.785F * static_cast<float>(v % 8);
    const float y = std::cos(angle), z = std::sin(angle);
    shape.vertices.push_back({{0.0005F * ring, 1e-4F * y, 1e-4F * z}, {0, y, z}});
    shape.colours.push_back(v < 800 ? 0xFF102030 : 0xFF203040);
    if (v % 8 == 0 && v > 0) graphics::joinRows(v - 8, v, 8, true, shape);
  }
  return shape;
}

TEST(ShapeMessage, HoldsTheShapeInLittleMoreThanAThirdOfItsBytes) {
  const graphics::ColouredShape shape = tube();
  const Bytes bytes = encodeShape(Kind::Threads, shape, {{0.0995, 0, 0}});
  EXPECT_LT(28 * bytes.size(), 10 * (20 * shape.vertices.size() + 4 * shape.triangles.size()));
  float box[6];
  std::memcpy(box, bytes.data() + 20, sizeof box);
  for (std::size_t i = 0; i < 3 * shape.vertices.size(); ++i) {
    std::uint16_t place;
    std::memcpy(&place, bytes.data() + 44 + 2 * i, sizeof place);
    ASSERT_NEAR(box[i % 3] + box[3 + i % 3] * place, shape.vertices[i / 3].position[i % 3], 1e-6);
    const auto normal = static_cast<std::int8_t>(bytes[44 + 6 * shape.vertices.size() + 6 + i]);
    ASSERT_NEAR(normal / 127.0, shape.vertices[i / 3].normal[i % 3], 0.005);
  }
  std::uint16_t point;
  std::memcpy(&point, bytes.data() + 44 + 6 * shape.vertices.size(), sizeof point);
  EXPECT_EQ(point, 65535);
  const std::uint8_t* at = bytes.data() + 44 + 9 * shape.vertices.size() + 6;
  for (const graphics::PackedColour colour : {0xFF102030, 0xFF203040}) {
    EXPECT_EQ(std::memcmp(at, &colour, sizeof colour), 0);
    at += sizeof colour;
    EXPECT_EQ(whole(at), 800U);
  }
  std::uint32_t corner = 0;
  for (const std::uint32_t expected : shape.triangles) {
    const std::uint32_t d = whole(at);
    corner += d % 2 == 0 ? d / 2 : 0U - (d + 1) / 2;
    ASSERT_EQ(corner, expected);
  }
  EXPECT_EQ(at, bytes.data() + bytes.size());
}

TEST(ShapeMessage, NothingIsAHeader) {
  EXPECT_EQ(encodeShape(Kind::Blood, {}).size(), 44U);
}

}  // namespace
}  // namespace vibe::web::shape_message_test
