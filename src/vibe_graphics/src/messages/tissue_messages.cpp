#include "vibe_graphics/messages/tissue_messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "vibe_graphics/messages/cloud_field.hpp"

namespace vibe::graphics {
namespace {

constexpr std::size_t kMaxParticles = 10'000'000;  // more is a mistake
constexpr std::uint8_t kMaxGrade = 3;
constexpr float kMaxWeight = 1000.0F;  // of a particle in a vertex of the render surface

std::string checkTriangles(const std::vector<std::uint32_t>& triangles, std::size_t count, const char* array) {
  if (triangles.size() % 3 != 0)
    return std::string(array) + " of the topology has " + std::to_string(triangles.size()) +
           " entries, which is not a multiple of 3.";
  for (const std::uint32_t corner : triangles)
    if (corner >= count)
      return std::string(array) + " of the topology refers to vertex " + std::to_string(corner) +
             ", but there are only " + std::to_string(count) + " vertices.";
  return {};
}

std::string checkRenderSurface(const vibe_msgs::TissueTopology& message, std::size_t particles) {
  const auto& offsets = message.render_offsets;
  if (message.render_weights.size() != message.render_particles.size())
    return "render_weights and render_particles of the topology have different lengths.";
  if (offsets.front() != 0 || offsets.back() != message.render_particles.size() ||
      !std::is_sorted(offsets.begin(), offsets.end()))
    return "render_offsets of the topology do not run from 0 to the length of render_particles.";
  for (const std::uint32_t particle : message.render_particles)
    if (particle >= particles) return "render_particles of the topology names a particle that does not exist.";
  for (const float weight : message.render_weights)
    if (!(std::abs(weight) <= kMaxWeight)) return "render_weights of the topology contains an invalid weight.";
  return {};
}

std::string checkRestPositions(const std::vector<double>& positions) {
  if (positions.size() % 3 != 0) return "The length of rest_positions of the topology is not a multiple of 3.";
  if (positions.empty()) return "The topology has no particles.";
  if (positions.size() / 3 > kMaxParticles) return "The topology has more than ten million particles.";
  for (const double value : positions)
    if (!(std::abs(value) < kMaxCoordinate))
      return "rest_positions of the topology contains an invalid position (not finite, or beyond 1000 km).";
  return {};
}

std::string checkAnatomy(const vibe_msgs::TissueTopology& message, std::size_t count) {
  for (const std::size_t length :
       {message.region.size(), message.wall.size(), message.end.size(), message.thickness.size()})
    if (length != 0 && length != count)
      return "region, wall, end or thickness of the topology do not have one entry per particle.";
  return {};
}

std::string checkTopology(const vibe_msgs::TissueTopology& message) {
  std::string wrong = checkRestPositions(message.rest_positions);
  const std::size_t count = message.rest_positions.size() / 3;
  if (wrong.empty()) wrong = checkTriangles(message.triangles, count, "triangles");
  if (wrong.empty()) wrong = checkAnatomy(message, count);
  if (!wrong.empty() || message.render_offsets.empty()) return wrong;
  wrong = checkRenderSurface(message, count);
  return wrong.empty() ? checkTriangles(message.render_triangles, message.render_offsets.size() - 1, "render_triangles")
                       : wrong;
}

void takeRest(const std::vector<double>& positions, TissueMesh& mesh) {
  mesh.particle_rest.resize(positions.size());
  std::transform(positions.begin(), positions.end(), mesh.particle_rest.begin(),
                 [](double p) { return static_cast<float>(p); });
  mesh.rest = mesh.particle_rest;
  if (!mesh.subdivided()) return;
  mesh.rest.assign(3 * mesh.vertex_count, 0.0F);
  for (std::size_t v = 0; v < mesh.vertex_count; ++v)
    for (std::uint32_t k = mesh.render_offsets[v]; k < mesh.render_offsets[v + 1]; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        mesh.rest[3 * v + c] += mesh.render_weights[k] * mesh.particle_rest[3 * mesh.render_particles[k] + c];
}

bool arePositions(const float* values, std::size_t count, std::size_t& where) {
  for (where = 0; where < count; ++where)
    if (!(std::abs(static_cast<double>(values[where])) < kMaxCoordinate)) return false;
  return true;
}

std::string checkRevision(const CloudField& field, std::size_t count, std::uint32_t revision) {
  for (std::size_t i = 0; i < count; ++i)
    if (field.at<std::uint32_t>(i) != revision)
      return "The particles belong to topology revision " + std::to_string(field.at<std::uint32_t>(i)) +
             ", but the topology has revision " + std::to_string(revision) + "; waiting for the matching one.";
  return {};
}

template <class T>
void take(const CloudField& field, std::size_t count, std::vector<T>& values) {
  values.resize(field.present() ? count : 0);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = field.at<T>(i);
}

}  // namespace

std::string readTopology(const vibe_msgs::TissueTopology& message, TissueMesh& mesh) {
  const std::string wrong = checkTopology(message);
  if (!wrong.empty()) return wrong;
  mesh = {};
  mesh.revision = message.revision;
  mesh.name = message.name;
  mesh.frame_id = message.header.frame_id;
  mesh.particle_count = message.rest_positions.size() / 3;
  mesh.particle_triangles = message.triangles;
  mesh.render_offsets = message.render_offsets;
  mesh.render_particles = message.render_particles;
  mesh.render_weights = message.render_weights;
  mesh.triangles = mesh.subdivided() ? message.render_triangles : message.triangles;
  mesh.vertex_count = mesh.subdivided() ? mesh.render_offsets.size() - 1 : mesh.particle_count;
  mesh.region = message.region;
  mesh.wall = message.wall;
  mesh.end = message.end;
  mesh.thickness = message.thickness;
  takeRest(message.rest_positions, mesh);
  return {};
}

std::string readParticles(const sensor_msgs::PointCloud2& message, const TissueMesh& mesh, TissueFrame& frame) {
  const std::size_t count = std::size_t{message.width} * message.height;
  CloudField x, y, z, revision, strain, grade, dose, first_seen;
  std::string wrong = checkLayout(message);
  if (wrong.empty()) wrong = findField(message, "x", sensor_msgs::PointField::FLOAT32, true, x);
  if (wrong.empty()) wrong = findField(message, "y", sensor_msgs::PointField::FLOAT32, true, y);
  if (wrong.empty()) wrong = findField(message, "z", sensor_msgs::PointField::FLOAT32, true, z);
  if (wrong.empty()) wrong = findField(message, "revision", sensor_msgs::PointField::UINT32, true, revision);
  if (wrong.empty()) wrong = findField(message, "strain", sensor_msgs::PointField::FLOAT32, false, strain);
  if (wrong.empty()) wrong = findField(message, "grade", sensor_msgs::PointField::UINT8, false, grade);
  if (wrong.empty()) wrong = findField(message, "thermal_dose", sensor_msgs::PointField::FLOAT32, false, dose);
  if (wrong.empty()) wrong = findField(message, "first_seen", sensor_msgs::PointField::FLOAT32, false, first_seen);
  if (wrong.empty()) wrong = checkRevision(revision, count, mesh.revision);
  if (!wrong.empty()) return wrong;
  if (count != mesh.particle_count)
    return "The cloud has " + std::to_string(count) + " particles and the topology " +
           std::to_string(mesh.particle_count) + ".";
  frame.revision = mesh.revision;
  frame.time = message.header.stamp.toSec();
  frame.positions.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    frame.positions[3 * i] = x.at<float>(i);
    frame.positions[3 * i + 1] = y.at<float>(i);
    frame.positions[3 * i + 2] = z.at<float>(i);
  }
  std::size_t where = 0;
  if (!arePositions(frame.positions.data(), 3 * count, where))
    return "The position of particle " + std::to_string(where / 3) +
           " is invalid (not finite, or beyond 1000 km); the last valid frame is shown.";
  take(strain, count, frame.strain);
  take(grade, count, frame.grade);
  take(dose, count, frame.dose);
  take(first_seen, count, frame.first_seen);
  for (std::uint8_t& value : frame.grade) value = std::min(value, kMaxGrade);
  return {};
}

}  // namespace vibe::graphics
