#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "geometry/incidence.hpp"
#include "geometry/tissue_mesh.hpp"
#include "geometry/vertex_span.hpp"
#include "vibe_rviz_plugins/geometry/moving_vertex.hpp"

namespace vibe {

/// The drawn surface of an organ that moves: places and smooth normals of its vertices from those of its particles.
/// Work grows with what has moved: vertices of particles that stay where they are are not touched. Up to rounding of
/// single precision the result does not depend on what was drawn before.
class DeformableSurface {
 public:
  explicit DeformableSurface(const TissueMesh& mesh);

  /// @param positions  x y z per particle, finite [m]
  /// @return  the vertices that are no longer what they were
  VertexSpan update(const std::vector<float>& positions);

  /// Normals point outward. That of a particle is the mean of its triangles' weighted by their areas; a render surface
  /// mixes the normals of its particles as it mixes their places.
  const std::vector<MovingVertex>& vertices() const { return vertices_; }
  /// Around all vertices; empty before the first update.
  const Eigen::AlignedBox3f& bounds() const { return bounds_; }

 private:
  void findMoved(const std::vector<float>& positions);
  void moveAll();
  VertexSpan movePart();
  void findNormal(std::size_t triangle);
  void findParticleNormal(std::size_t particle);
  void writeVertex(std::size_t vertex);
  void findBounds();

  // what does not change
  std::vector<std::uint32_t> triangles_;  // of particles
  std::vector<std::uint32_t> render_offsets_, render_particles_;
  std::vector<float> render_weights_;
  Incidence triangles_of_particle_, vertices_of_particle_;  // the latter is empty without a render surface

  // as drawn last
  std::vector<float> positions_;
  std::vector<Eigen::Vector4f> places_, normals_;  // of particles; the fourth is 0
  std::vector<Eigen::Vector4f> areas_;             // normals of triangles, twice as long as their areas
  std::vector<MovingVertex> vertices_;
  Eigen::AlignedBox3f bounds_;

  // scratch, so that a frame allocates nothing
  std::vector<std::uint32_t> moved_, touched_;  // particles
  std::vector<std::uint32_t> touched_triangles_, touched_vertices_;
  std::vector<std::uint8_t> particle_mark_, triangle_mark_, vertex_mark_;
};

}  // namespace vibe
