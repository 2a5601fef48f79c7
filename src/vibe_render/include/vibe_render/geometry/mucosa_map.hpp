#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_render/geometry/tissue_mesh.hpp"

namespace vibe::render {

/// What the mucosa looks like at a vertex, from the anatomy alone: constant while the organ moves. All of it is smooth
/// across the borders of regions. Layout of a vertex buffer.
struct MucosaVertex {
  float around[2];  ///< cosine and sine of the angle around the organ, 0: anterior, pi/2: greater curvature, times how
                    ///< well it is defined, 0 to 1: at the apex of the fundus it is not [1]
  float bend;       ///< by which the phase of the folds wanders, see foldBend() [rad]
  float broad;      ///< blotches of 42 mm and less, see broadPattern(), 0 to 1
  float folded;     ///< how much of the rugae this region has: 1 body and fundus, 0 oesophagus and pylorus [1]
  float antral;     ///< 1: antrum and pylorus, paler and smoother [1]
  float beyond_z;   ///< distance from the Z line, positive on the side of the stomach; 1 m without an oesophagus [m]
  float beyond_ring;  ///< distance from the narrowest place of the pylorus, positive towards the duodenum; -1 m without
                      ///< one [m]
};
static_assert(sizeof(MucosaVertex) == 32, "the vertex buffer has no gaps");

struct MucosaMap {
  std::vector<MucosaVertex> of_particle, of_vertex;
  /// Per particle: stretch around the organ from which on the wall has no rugae, see foldHeight() [1].
  std::vector<float> smooth_stretch;
};

/// Folds of the gastric mucosa run along the organ, so the coordinate that counts them goes around it. It is found from
/// the walls of the topology, four sectors of equal angle, by diffusion over the surface at rest (implicit Euler).
/// Without regions the organ has no folds.
/// @param shift  of the patterns, see MucosaLook [m]
MucosaMap mapMucosa(const TissueMesh& mesh, const Eigen::Vector3f& shift = {0, 0, 0});

}  // namespace vibe::render
