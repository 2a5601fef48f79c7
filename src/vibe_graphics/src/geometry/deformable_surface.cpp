#include "vibe_graphics/geometry/deformable_surface.hpp"

#include <cstring>

namespace vibe::graphics {
namespace {

constexpr std::size_t kMaxMovedShare = 4;  // if more than one particle in this many has moved, all are updated

// Adds an item to a list once; whoever clears the list also clears the marks.
void addOnce(std::uint32_t item, std::vector<std::uint8_t>& marks, std::vector<std::uint32_t>& list) {
  if (marks[item] != 0) return;
  marks[item] = 1;
  list.push_back(item);
}

}  // namespace

DeformableSurface::DeformableSurface(const TissueMesh& mesh)
    : triangles_(mesh.particle_triangles),
      render_offsets_(mesh.render_offsets),
      render_particles_(mesh.render_particles),
      render_weights_(mesh.render_weights),
      triangles_of_particle_(turnedAround(mesh.particle_triangles, 3, mesh.particle_count)) {
  if (mesh.subdivided()) vertices_of_particle_ = turnedAround(render_offsets_, render_particles_, mesh.particle_count);
  places_.assign(mesh.particle_count, Eigen::Vector4f::Zero());
  normals_.assign(mesh.particle_count, Eigen::Vector4f::Zero());
  areas_.assign(triangles_.size() / 3, Eigen::Vector4f::Zero());
  vertices_.assign(mesh.vertex_count, MovingVertex{{0, 0, 0}, {0, 0, 1}});
  particle_mark_.assign(mesh.particle_count, 0);
  triangle_mark_.assign(areas_.size(), 0);
  vertex_mark_.assign(mesh.vertex_count, 0);
}

VertexSpan DeformableSurface::update(const std::vector<float>& positions) {
  const bool first = positions_.empty();
  if (first) positions_.assign(positions.size(), 0);
  findMoved(positions);
  if (first || moved_.size() * kMaxMovedShare >= places_.size()) {
    moveAll();
    return {0, vertices_.size()};
  }
  return moved_.empty() ? VertexSpan{} : movePart();
}

void DeformableSurface::findMoved(const std::vector<float>& positions) {
  moved_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const float* place = &positions[3 * i];
    if (std::memcmp(place, &positions_[3 * i], 3 * sizeof(float)) == 0) continue;
    moved_.push_back(static_cast<std::uint32_t>(i));
    places_[i] = {place[0], place[1], place[2], 0};
    std::memcpy(&positions_[3 * i], place, 3 * sizeof(float));
  }
}

void DeformableSurface::findNormal(std::size_t triangle) {
  const std::uint32_t* corner = &triangles_[3 * triangle];
  const Eigen::Vector4f& a = places_[corner[0]];
  const Eigen::Vector4f ab = places_[corner[1]] - a, ac = places_[corner[2]] - a;
  areas_[triangle] = ab.cross3(ac);
}

void DeformableSurface::findParticleNormal(std::size_t particle) {
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  const std::uint32_t* last = triangles_of_particle_.end(particle);
  for (const std::uint32_t* t = triangles_of_particle_.begin(particle); t != last; ++t) sum += areas_[*t];
  const float length = sum.norm();
  normals_[particle] = length > 0 ? Eigen::Vector4f(sum / length) : sum;
}

void DeformableSurface::writeVertex(std::size_t vertex) {
  Eigen::Vector4f place, normal;
  if (render_offsets_.empty()) {
    place = places_[vertex], normal = normals_[vertex];
  } else {
    place.setZero(), normal.setZero();
    for (std::uint32_t k = render_offsets_[vertex]; k < render_offsets_[vertex + 1]; ++k) {
      place += render_weights_[k] * places_[render_particles_[k]];
      normal += render_weights_[k] * normals_[render_particles_[k]];
    }
    const float length = normal.norm();
    if (length > 0) normal /= length;
  }
  MovingVertex& out = vertices_[vertex];
  std::memcpy(out.position, place.data(), sizeof out.position);
  std::memcpy(out.normal, normal.data(), sizeof out.normal);
}

void DeformableSurface::moveAll() {
  for (std::size_t t = 0; t < areas_.size(); ++t) findNormal(t);
  for (std::size_t i = 0; i < normals_.size(); ++i) findParticleNormal(i);
  for (std::size_t v = 0; v < vertices_.size(); ++v) writeVertex(v);
  findBounds();
}

VertexSpan DeformableSurface::movePart() {
  touched_.clear(), touched_triangles_.clear(), touched_vertices_.clear();
  for (const std::uint32_t i : moved_) {
    addOnce(i, particle_mark_, touched_);
    for (const std::uint32_t* t = triangles_of_particle_.begin(i); t != triangles_of_particle_.end(i); ++t)
      addOnce(*t, triangle_mark_, touched_triangles_);
  }
  for (const std::uint32_t t : touched_triangles_) {
    findNormal(t), triangle_mark_[t] = 0;
    for (std::size_t c = 0; c < 3; ++c) addOnce(triangles_[3 * t + c], particle_mark_, touched_);
  }
  for (const std::uint32_t i : touched_) {
    findParticleNormal(i), particle_mark_[i] = 0;
    if (render_offsets_.empty())
      addOnce(i, vertex_mark_, touched_vertices_);
    else
      for (const std::uint32_t* v = vertices_of_particle_.begin(i); v != vertices_of_particle_.end(i); ++v)
        addOnce(*v, vertex_mark_, touched_vertices_);
  }
  VertexSpan span;
  for (const std::uint32_t v : touched_vertices_) writeVertex(v), span.add(v), vertex_mark_[v] = 0;
  findBounds();
  return span;
}

void DeformableSurface::findBounds() {
  bounds_.setEmpty();
  for (const MovingVertex& vertex : vertices_) bounds_.extend(Eigen::Map<const Eigen::Vector3f>(vertex.position));
}

}  // namespace vibe::graphics
