#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::graphics {

/// Constant data of an organ, from tissue/topology. A "vertex" belongs to the drawn surface, a "particle" to the
/// simulated one; without a render surface they are the same.
struct TissueMesh {
  std::uint32_t revision = 0;                        ///< frames must have the same revision
  std::string name;                                  ///< of the scene
  std::string frame_id;                              ///< of the positions at rest
  std::size_t particle_count = 0, vertex_count = 0;  ///< both the same without a render surface

  std::vector<std::uint32_t> triangles;           ///< three vertices each, counter-clockwise seen from outside
  std::vector<std::uint32_t> particle_triangles;  ///< three particles each; the same without a render surface
  std::vector<float> rest;                        ///< x y z per vertex [m]
  std::vector<float> particle_rest;               ///< x y z per particle [m]; the same without a render surface

  /// Vertex v is the sum over k in [render_offsets[v], render_offsets[v + 1]) of render_weights[k] times particle
  /// render_particles[k]. All empty without a render surface.
  std::vector<std::uint32_t> render_offsets, render_particles;
  std::vector<float> render_weights;                           ///< of the particles of a vertex, sum 1
  bool subdivided() const { return !render_offsets.empty(); }  ///< there is a render surface

  // Per particle; empty if the topology does not tell.
  std::vector<std::uint8_t> region, wall;  ///< REGION_* and WALL_* of vibe_msgs/TissueTopology
  std::vector<std::uint8_t> end;           ///< END_*
  std::vector<float> thickness;            ///< of the wall at rest [m]
};

/// The particles at one moment, as tissue/particles tells them.
struct TissueFrame {
  std::uint32_t revision = 0;    ///< of the mesh that the frame is of
  double time = 0;               ///< of the sample [s]
  std::vector<float> positions;  ///< x y z per particle [m]
  std::vector<float> strain;     ///< mean in-plane stretch minus 1; empty if not given
  std::vector<std::uint8_t>
      grade;                      ///< 0 none, 1 mark, 2 burn scar, 3 muscularis at risk; empty in scenes without marks
  std::vector<float> dose;        ///< largest heat so far, as energy of a whole spot [J]; empty like grade
  std::vector<float> first_seen;  ///< by the lens [s], not a number: not yet; empty in scenes without `inspection`
};

}  // namespace vibe::graphics
