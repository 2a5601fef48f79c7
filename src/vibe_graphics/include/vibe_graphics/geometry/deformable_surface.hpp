#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/mesh_index.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics {

/// The drawn surface of a moving organ: positions and smooth normals of the vertices from those of the particles. The
/// cost grows with the number of moved particles, because vertices of particles at rest are not updated. Up to rounding
/// in single precision, the result does not depend on earlier frames.
class DeformableSurface {
 public:
  explicit DeformableSurface(const TissueMesh& mesh);  ///< without places until the first update()

  /// @param positions  x y z per particle, finite [m]
  /// @return  the vertices that have changed
  VertexSpan update(const std::vector<float>& positions);

  /// Normals point outward. The normal of a particle is the mean over its triangles weighted by area; a vertex of a
  /// render surface interpolates normals with the same weights as positions.
  const std::vector<MovingVertex>& vertices() const { return vertices_; }
  /// Bounding box of all vertices; empty before the first update.
  const Eigen::AlignedBox3f& bounds() const { return bounds_; }

 private:
  void findMoved(const std::vector<float>& positions);
  void moveAll();
  VertexSpan movePart();
  void findNormal(std::size_t triangle);
  void findParticleNormal(std::size_t particle);
  void writeVertex(std::size_t vertex);
  void findBounds();

  // constant
  std::vector<std::uint32_t> triangles_;  // of particles
  std::vector<std::uint32_t> render_offsets_, render_particles_;
  std::vector<float> render_weights_;
  Incidence triangles_of_particle_, vertices_of_particle_;  // the latter is empty without a render surface

  // of the last frame
  std::vector<float> positions_;
  std::vector<Eigen::Vector4f> places_, normals_;  // of particles; the fourth is 0
  std::vector<Eigen::Vector4f> areas_;             // normals of triangles with twice the area as length
  std::vector<MovingVertex> vertices_;
  Eigen::AlignedBox3f bounds_;

  // scratch memory, so that a frame allocates nothing
  std::vector<std::uint32_t> moved_, touched_;  // particles
  std::vector<std::uint32_t> touched_triangles_, touched_vertices_;
  std::vector<std::uint8_t> particle_mark_, triangle_mark_, vertex_mark_;
};

}  // namespace vibe::graphics
