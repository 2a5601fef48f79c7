#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "geometry/incidence.hpp"
#include "geometry/moving_vertex.hpp"
#include "geometry/tissue_mesh.hpp"
#include "geometry/vertex_span.hpp"

namespace vibe {

/// The drawn surface of an organ that moves: places and smooth normals of its vertices from those of its particles.
/// Work grows with what has moved: vertices of particles that stay where they are are not touched. Up to rounding of
/// single precision the result does not depend on what was drawn before.
class LivingSurface {
 public:
  explicit LivingSurface(const TissueMesh& mesh);

  /// @param positions  x y z per particle, finite [m]
  /// @return  the vertices that are no longer what they were
  VertexSpan update(const std::vector<float>& positions);

  /// Normals are means of the neighbouring triangles' weighted by their areas, pointing outward.
  const std::vector<MovingVertex>& vertices() const { return vertices_; }
  /// Around all vertices; empty before the first update.
  const Eigen::AlignedBox3f& bounds() const { return bounds_; }

 private:
  void findMoved(const std::vector<float>& positions);
  void moveAll(const std::vector<float>& positions);
  VertexSpan movePart(const std::vector<float>& positions);
  void markNeighbours(std::vector<std::uint32_t>& vertices);
  Eigen::Vector4f placeOf(std::size_t vertex, const std::vector<float>& positions) const;
  Eigen::Vector4f normalOf(std::size_t triangle) const;
  void writeVertex(std::size_t vertex);
  void findBounds();

  // what does not change
  std::vector<std::uint32_t> triangles_, skin_offsets_, skin_particles_;
  std::vector<float> skin_weights_;
  Incidence triangles_of_vertex_, vertices_of_particle_;  // the latter is empty without a skin

  // as drawn last
  std::vector<float> positions_;
  std::vector<Eigen::Vector4f> places_, normals_;  // of vertices, of triangles (twice the area); the fourth is 0
  std::vector<MovingVertex> vertices_;
  Eigen::AlignedBox3f bounds_;

  // scratch, so that a frame allocates nothing
  std::vector<std::uint32_t> moved_;  // particles
  std::vector<std::uint32_t> touched_vertices_, touched_triangles_;
  std::vector<std::uint8_t> vertex_mark_, triangle_mark_;
};

}  // namespace vibe
