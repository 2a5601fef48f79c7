#include "geometry/living_surface.hpp"

#include <cstring>

namespace vibe {
namespace {

constexpr std::size_t kFewerThan = 4;  // a part of the particles above one in so many is not worth telling apart

Eigen::Vector4f particle(const std::vector<float>& positions, std::size_t number) {
  return {positions[3 * number], positions[3 * number + 1], positions[3 * number + 2], 0.0F};
}

}  // namespace

LivingSurface::LivingSurface(const TissueMesh& mesh)
    : triangles_(mesh.triangles),
      skin_offsets_(mesh.skin_offsets),
      skin_particles_(mesh.skin_particles),
      skin_weights_(mesh.skin_weights),
      triangles_of_vertex_(turnedAround(mesh.triangles, 3, mesh.vertex_count)) {
  if (mesh.skinned()) vertices_of_particle_ = turnedAround(skin_offsets_, skin_particles_, mesh.particle_count);
  places_.assign(mesh.vertex_count, Eigen::Vector4f::Zero());
  normals_.assign(triangles_.size() / 3, Eigen::Vector4f::Zero());
  vertices_.assign(mesh.vertex_count, MovingVertex{{0, 0, 0}, {0, 0, 1}});
  vertex_mark_.assign(mesh.vertex_count, 0);
  triangle_mark_.assign(normals_.size(), 0);
}

VertexSpan LivingSurface::update(const std::vector<float>& positions) {
  if (positions_.size() != positions.size()) {
    moveAll(positions);
    return {0, vertices_.size()};
  }
  findMoved(positions);
  if (moved_.empty()) return {};
  if (moved_.size() * kFewerThan < positions.size() / 3) return movePart(positions);
  moveAll(positions);
  return {0, vertices_.size()};
}

void LivingSurface::findMoved(const std::vector<float>& positions) {
  moved_.clear();
  const std::size_t count = positions.size() / 3;
  for (std::size_t i = 0; i < count; ++i)
    if (std::memcmp(&positions[3 * i], &positions_[3 * i], 3 * sizeof(float)) != 0)
      moved_.push_back(static_cast<std::uint32_t>(i));
}

Eigen::Vector4f LivingSurface::placeOf(std::size_t vertex, const std::vector<float>& positions) const {
  if (skin_offsets_.empty()) return particle(positions, vertex);
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (std::uint32_t k = skin_offsets_[vertex]; k < skin_offsets_[vertex + 1]; ++k)
    sum += skin_weights_[k] * particle(positions, skin_particles_[k]);
  return sum;
}

Eigen::Vector4f LivingSurface::normalOf(std::size_t triangle) const {
  const std::uint32_t* corner = &triangles_[3 * triangle];
  const Eigen::Vector4f& a = places_[corner[0]];
  const Eigen::Vector4f ab = places_[corner[1]] - a, ac = places_[corner[2]] - a;
  return ab.cross3(ac);
}

void LivingSurface::writeVertex(std::size_t vertex) {
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  const std::uint32_t* last = triangles_of_vertex_.end(vertex);
  for (const std::uint32_t* t = triangles_of_vertex_.begin(vertex); t != last; ++t) sum += normals_[*t];
  const float length = sum.norm();
  if (length > 0) sum /= length;
  MovingVertex& out = vertices_[vertex];
  for (int c = 0; c < 3; ++c) out.position[c] = places_[vertex][c], out.normal[c] = sum[c];
}

void LivingSurface::moveAll(const std::vector<float>& positions) {
  for (std::size_t v = 0; v < places_.size(); ++v) places_[v] = placeOf(v, positions);
  for (std::size_t t = 0; t < normals_.size(); ++t) normals_[t] = normalOf(t);
  for (std::size_t v = 0; v < vertices_.size(); ++v) writeVertex(v);
  positions_ = positions;
  findBounds();
}

void LivingSurface::markNeighbours(std::vector<std::uint32_t>& vertices) {
  touched_triangles_.clear();
  for (const std::uint32_t v : vertices)
    for (const std::uint32_t* t = triangles_of_vertex_.begin(v); t != triangles_of_vertex_.end(v); ++t)
      if (triangle_mark_[*t] == 0) triangle_mark_[*t] = 1, touched_triangles_.push_back(*t);
  for (const std::uint32_t t : touched_triangles_)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = triangles_[3 * t + c];
      if (vertex_mark_[v] == 0) vertex_mark_[v] = 1, vertices.push_back(v);
    }
}

VertexSpan LivingSurface::movePart(const std::vector<float>& positions) {
  touched_vertices_.clear();
  const auto touch = [this](std::uint32_t v) {
    if (vertex_mark_[v] == 0) vertex_mark_[v] = 1, touched_vertices_.push_back(v);
  };
  for (const std::uint32_t i : moved_) {
    std::memcpy(&positions_[3 * i], &positions[3 * i], 3 * sizeof(float));
    if (skin_offsets_.empty())
      touch(i);
    else
      std::for_each(vertices_of_particle_.begin(i), vertices_of_particle_.end(i), touch);
  }
  for (const std::uint32_t v : touched_vertices_) places_[v] = placeOf(v, positions);
  markNeighbours(touched_vertices_);
  for (const std::uint32_t t : touched_triangles_) normals_[t] = normalOf(t), triangle_mark_[t] = 0;
  VertexSpan span;
  for (const std::uint32_t v : touched_vertices_) writeVertex(v), span.add(v), vertex_mark_[v] = 0;
  findBounds();
  return span;
}

void LivingSurface::findBounds() {
  if (places_.empty()) return;
  Eigen::Vector4f least = places_.front(), greatest = places_.front();
  for (const Eigen::Vector4f& place : places_) least = least.cwiseMin(place), greatest = greatest.cwiseMax(place);
  bounds_ = Eigen::AlignedBox3f(least.head<3>(), greatest.head<3>());
}

}  // namespace vibe
