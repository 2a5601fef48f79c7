#include "bench_organ.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "vibe_graphics/testing/surfaces.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr std::uint32_t kRows = 113, kAround = 32;  // and two poles
constexpr float kLength = 0.1F, kRadius = 0.045F;   // half axes [m]
constexpr double kPi = 3.14159265358979;
constexpr double kPatch = 0.05;  // share of the particles
constexpr double kBreath = 60;   // frames
constexpr std::size_t kBytes = 32;

// Each triangle in four; a new vertex follows both ends of its edge.
void addRenderSurface(graphics::TissueMesh& mesh) {
  mesh.render_offsets.push_back(0);
  const auto update = [&mesh](std::initializer_list<std::uint32_t> particles) {
    for (const std::uint32_t particle : particles) {
      mesh.render_particles.push_back(particle);
      mesh.render_weights.push_back(1.0F / static_cast<float>(particles.size()));
    }
    mesh.render_offsets.push_back(static_cast<std::uint32_t>(mesh.render_particles.size()));
  };
  for (std::uint32_t particle = 0; particle < mesh.particle_count; ++particle) update({particle});
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), mesh.render_offsets.size() - 1);
    if (is_new) {
      update({a, b});
      for (int c = 0; c < 3; ++c) mesh.rest.push_back((mesh.rest[3 * a + c] + mesh.rest[3 * b + c]) / 2);
    }
    return entry->second;
  };
  mesh.triangles.clear();
  for (std::size_t t = 0; t < mesh.particle_triangles.size(); t += 3) {
    const std::uint32_t *corner = &mesh.particle_triangles[t], a = corner[0], b = corner[1], c = corner[2];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangles.insert(mesh.triangles.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
  }
  mesh.vertex_count = mesh.render_offsets.size() - 1;
}

// How far particle i has gone outward at this frame, as a share of its place.
double bulgeOf(const graphics::TissueMesh& mesh, Motion motion, int frame, std::size_t i) {
  const double breath = 0.05 * std::sin(2 * kPi * frame / kBreath);
  if (motion == Motion::Everything) return breath;
  if (motion == Motion::Nothing) return 0;
  // a square of rows and columns
  const std::size_t row = i == 0 ? 0 : (i - 1) / kAround, place = i == 0 ? 0 : (i - 1) % kAround;
  const auto side = static_cast<std::size_t>(std::sqrt(kPatch * static_cast<double>(mesh.particle_count)));
  const bool inside = row >= kRows / 2 && row < kRows / 2 + side && place < side;
  return inside ? breath : 0;
}

template <class T>
void put(std::vector<std::uint8_t>& data, std::size_t offset, T value) {
  std::memcpy(&data[offset], &value, sizeof value);
}

void describe(sensor_msgs::PointCloud2& cloud) {
  using Field = sensor_msgs::PointField;
  const auto add = [&cloud](const char* name, std::uint32_t offset, std::uint8_t type) {
    Field field;
    field.name = name, field.offset = offset, field.datatype = type, field.count = 1;
    cloud.fields.push_back(field);
  };
  add("x", 0, Field::FLOAT32), add("y", 4, Field::FLOAT32), add("z", 8, Field::FLOAT32);
  add("strain", 12, Field::FLOAT32), add("id", 16, Field::UINT32), add("revision", 20, Field::UINT32);
  add("region", 24, Field::UINT8), add("grade", 25, Field::UINT8), add("thermal_dose", 28, Field::FLOAT32);
}

}  // namespace

graphics::TissueMesh benchOrgan(bool subdivided) {
  graphics::TissueMesh mesh = graphics::test::ballMesh(kRows, kAround);
  mesh.name = "egg";
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) mesh.rest[i] *= i % 3 == 2 ? kLength : kRadius;
  mesh.particle_rest = mesh.rest;
  if (subdivided) addRenderSurface(mesh);
  return mesh;
}

sensor_msgs::PointCloud2 benchCloud(const graphics::TissueMesh& mesh, Motion motion, int frame) {
  sensor_msgs::PointCloud2 cloud;
  describe(cloud);
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(mesh.particle_count);
  cloud.point_step = kBytes;
  cloud.row_step = static_cast<std::uint32_t>(kBytes * mesh.particle_count);
  cloud.data.resize(cloud.row_step);
  for (std::size_t i = 0; i < mesh.particle_count; ++i) {
    const auto bulge = static_cast<float>(bulgeOf(mesh, motion, frame, i));
    const std::size_t at = kBytes * i;
    for (std::size_t c = 0; c < 3; ++c) put(cloud.data, at + 4 * c, mesh.rest[3 * i + c] * (1 + bulge));
    put(cloud.data, at + 12, bulge);
    put(cloud.data, at + 16, static_cast<std::uint32_t>(i));
    put(cloud.data, at + 20, mesh.revision);
  }
  return cloud;
}

}  // namespace vibe::rviz_plugins
