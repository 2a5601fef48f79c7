#include "vibe_graphics/messages/tissue_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace vibe::graphics::tissue_messages_test {
namespace {

vibe_msgs::TissueTopology tetrahedron() {
  vibe_msgs::TissueTopology message;
  message.header.frame_id = "stomach";
  message.revision = 7;
  message.name = "tetrahedron";
  message.rest_positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  message.region = {0, 1, 2, 3};
  message.wall = {0, 1, 2, 3};
  message.thickness = {1, 1, 1, 1};
  return message;
}

vibe_msgs::TissueTopology withRenderSurface() {
  vibe_msgs::TissueTopology message = tetrahedron();
  message.render_offsets = {0, 2, 3, 4};
  message.render_particles = {0, 1, 2, 3};
  message.render_weights = {0.5, 0.5, 1, 1};
  message.render_triangles = {0, 1, 2};
  return message;
}

struct Point {
  float x, y, z, strain;
  std::uint32_t id, revision;
  std::uint8_t region, grade;
  float dose;
} __attribute__((packed));

void addField(sensor_msgs::PointCloud2& cloud, const char* name, std::uint32_t offset, std::uint8_t type) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = type;
  field.count = 1;
  cloud.fields.push_back(field);
}

sensor_msgs::PointCloud2 cloudOf(std::uint32_t count, std::uint32_t revision) {
  using Field = sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "stomach";
  addField(cloud, "x", 0, Field::FLOAT32), addField(cloud, "y", 4, Field::FLOAT32),
      addField(cloud, "z", 8, Field::FLOAT32);
  addField(cloud, "strain", 12, Field::FLOAT32), addField(cloud, "revision", 20, Field::UINT32);
  addField(cloud, "grade", 25, Field::UINT8), addField(cloud, "thermal_dose", 26, Field::FLOAT32);
  cloud.point_step = sizeof(Point);
  cloud.width = count, cloud.height = 1, cloud.row_step = count * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto place = static_cast<float>(i);
    const Point point{place, 2 * place, 3 * place, 0.01F, i, revision, 0, static_cast<std::uint8_t>(i % 2), 5};
    std::memcpy(&cloud.data[i * sizeof point], &point, sizeof point);
  }
  return cloud;
}

TissueMesh mesh() {
  TissueMesh result;
  EXPECT_EQ(readTopology(tetrahedron(), result), "");
  return result;
}

TEST(ReadTopology, ReadsAllFields) {
  const TissueMesh result = mesh();
  EXPECT_EQ(result.revision, 7U);
  EXPECT_EQ(result.particle_count, 4U);
  EXPECT_EQ(result.vertex_count, 4U);
  EXPECT_EQ(result.triangles.size(), 12U);
  EXPECT_FALSE(result.subdivided());
  EXPECT_FLOAT_EQ(result.rest[3], 1);
}

TEST(ReadTopology, RestOfTheRenderSurfaceFollowsTheParticles) {
  TissueMesh result;
  ASSERT_EQ(readTopology(withRenderSurface(), result), "");
  EXPECT_EQ(result.vertex_count, 3U);
  EXPECT_EQ(result.triangles.size(), 3U);
  EXPECT_FLOAT_EQ(result.rest[0], 0.5F);
}

TEST(ReadTopology, ReportsFaultsAndKeepsTheFormerMesh) {
  using Spoil = std::function<void(vibe_msgs::TissueTopology&)>;
  const std::vector<Spoil> spoils{
      [](auto& m) { m.rest_positions.clear(); },
      [](auto& m) { m.rest_positions.pop_back(); },
      [](auto& m) { m.rest_positions[4] = std::nan(""); },
      [](auto& m) { m.triangles[5] = 4; },
      [](auto& m) { m.triangles.pop_back(); },
      [](auto& m) { m.region.pop_back(); },
      [](auto& m) { m.thickness.push_back(1); },
      [](auto& m) { m.render_offsets[1] = 3, m.render_offsets[2] = 1; },
      [](auto& m) { m.render_offsets.back() = 9; },
      [](auto& m) { m.render_offsets.front() = 1; },
      [](auto& m) { m.render_particles[2] = 4; },
      [](auto& m) { m.render_weights.pop_back(); },
      [](auto& m) { m.render_weights[1] = INFINITY; },
      [](auto& m) { m.render_weights[1] = -3e38F; },
      [](auto& m) { m.render_triangles[1] = 3; },
  };
  for (std::size_t k = 0; k < spoils.size(); ++k) {
    vibe_msgs::TissueTopology message = withRenderSurface();
    spoils[k](message);
    TissueMesh result = mesh();
    EXPECT_NE(readTopology(message, result), "") << k;
    EXPECT_EQ(result.name, "tetrahedron") << k;
  }
}

TEST(ReadParticles, ReadsAllFields) {
  TissueFrame frame;
  ASSERT_EQ(readParticles(cloudOf(4, 7), mesh(), frame), "");
  EXPECT_FLOAT_EQ(frame.positions[3 * 2 + 1], 4);
  EXPECT_FLOAT_EQ(frame.strain[3], 0.01F);
  EXPECT_EQ(frame.grade[1], 1);
  EXPECT_FLOAT_EQ(frame.dose[0], 5);
}

TEST(ReadParticles, MarksAndStrainMayBeAbsent) {
  sensor_msgs::PointCloud2 cloud = cloudOf(4, 7);
  cloud.fields.erase(cloud.fields.begin() + 5, cloud.fields.end());
  TissueFrame frame;
  ASSERT_EQ(readParticles(cloud, mesh(), frame), "");
  EXPECT_TRUE(frame.grade.empty());
  EXPECT_TRUE(frame.dose.empty());
}

TEST(ReadParticles, ReportsFaults) {
  using Spoil = std::function<void(sensor_msgs::PointCloud2&)>;
  const std::vector<std::pair<std::string, Spoil>> spoils{
      {"revision", [](auto& m) { m = cloudOf(4, 8); }},
      {"particles", [](auto& m) { m = cloudOf(5, 7); }},
      {"particle 2 is invalid",
       [](auto& m) {
         const float bad = NAN;
         std::memcpy(&m.data[2 * sizeof(Point) + 4], &bad, 4);
       }},
      {"particle 3 is invalid",
       [](auto& m) {
         const float bad = 3e38F;  // finite, but the organ around it is not
         std::memcpy(&m.data[3 * sizeof(Point) + 8], &bad, 4);
       }},
      {"cut short", [](auto& m) { m.data.resize(m.data.size() - 1); }},
      {"'y'", [](auto& m) { m.fields[1].name = "why"; }},
      {"another type", [](auto& m) { m.fields[0].datatype = sensor_msgs::PointField::FLOAT64; }},
      {"another type", [](auto& m) { m.fields[5].datatype = sensor_msgs::PointField::INT32; }},
      {"outside", [](auto& m) { m.fields[3].offset = sizeof(Point) - 3; }},
      {"big-endian", [](auto& m) { m.is_bigendian = 1; }},
      {"gaps", [](auto& m) { m.height = 2, m.width = 2; }},
  };
  for (const auto& [word, spoil] : spoils) {
    sensor_msgs::PointCloud2 message = cloudOf(4, 7);
    spoil(message);
    TissueFrame frame;
    const std::string said = readParticles(message, mesh(), frame);
    EXPECT_NE(said.find(word), std::string::npos) << word << ": " << said;
  }
}

TEST(ReadParticles, RandomBytesDoNotCrash) {
  std::mt19937 engine(5);
  const auto random = [&engine] { return static_cast<std::uint32_t>(engine()); };
  const TissueMesh small = mesh();
  TissueFrame frame;
  int refused = 0;
  for (int k = 0; k < 2000; ++k) {
    sensor_msgs::PointCloud2 message = cloudOf(4, 7);
    message.width = random() % 6, message.height = random() % 3;
    message.point_step = random() % 64;
    message.row_step = message.width * message.point_step;
    for (auto& field : message.fields) field.offset = random() % 80;
    message.data.resize(random() % 200);
    for (auto& byte : message.data) byte = static_cast<std::uint8_t>(random());
    if (!readParticles(message, small, frame).empty()) ++refused;
  }
  EXPECT_GT(refused, 1900);
}

}  // namespace
}  // namespace vibe::graphics::tissue_messages_test
