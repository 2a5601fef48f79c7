#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics {

/// What the mucosa looks like at a vertex, from the anatomy alone: constant while the organ moves. All of it is smooth
/// across the borders of regions. Layout of a vertex buffer.
struct MucosaVertex {
  float around[2];  ///< cosine and sine of the angle around the organ, 0: anterior, pi/2: greater curvature, times how
                    ///< well it is defined, 0 to 1: at the apex of the fundus it is not
  float bend;       ///< by which the phase of the folds wanders, see foldBend() [rad]
  float broad;      ///< blotches of 42 mm and less, see broadPattern(), 0 to 1
  float folded;     ///< how much of the rugae this region has: 1 body and fundus, 0 oesophagus and pylorus (ratio)
  float antral;     ///< 1: antrum and pylorus, paler and smoother
  float beyond_z;   ///< distance from the Z line, positive on the side of the stomach; 1 m without an oesophagus [m]
  float beyond_ring;  ///< distance from the narrowest place of the pylorus, positive towards the duodenum; -1 m without
                      ///< one [m]
};
static_assert(sizeof(MucosaVertex) == 32, "the vertex buffer has no gaps");

/// What mapMucosa() finds; of the mesh it was made of.
struct MucosaMap {
  std::vector<MucosaVertex> of_particle, of_vertex;  ///< one per particle, and one per vertex of the drawn surface
  /// Per particle: stretch around the organ from which on the wall has no rugae, see foldHeight().
  std::vector<float> smooth_stretch;
};

/// Folds of the gastric mucosa run along the organ, so the coordinate that counts them goes around it. It is found from
/// the walls of the topology, four sectors of equal angle, by diffusion over the surface at rest (implicit Euler).
/// Without regions the organ has no folds.
/// @param shift  of the patterns, see MucosaLook [m]
MucosaMap mapMucosa(const TissueMesh& mesh, const Eigen::Vector3f& shift = {0, 0, 0});

constexpr float kRestingFold = 3e-3F;    ///< at rest; "several millimetres" in descriptions; design choice [m]
constexpr float kTallestFold = 4.5e-3F;  ///< of a wall that is compressed; design choice [m]

/// Height of the rugae where the wall is stretched like this across them, for a region that has all of them
/// (MucosaVertex::folded) [m]. A fold is spare length of the mucosa, and the spare length of a shallow wave grows with
/// the square of its height. The wall uses up the spare length as it stretches, so
///   height = kRestingFold sqrt((smooth - stretch) / (smooth - 1)),
/// which falls monotonically and is 0 from `smooth` on.
/// @param stretch  1 at rest
/// @param smooth   MucosaMap::smooth_stretch, more than 1
float foldHeight(float stretch, float smooth);

/// The height of the rugae at the vertices of a moving organ, from the stretch of its particle mesh around the organ
/// against rest: the length of F t, with F the deformation gradient of a triangle and t the unit direction around the
/// organ at rest. Where that direction is not defined (apex of the fundus) the square root of the ratio of areas.
class FoldHeight {
 public:
  FoldHeight(const TissueMesh& mesh, const MucosaMap& map);  ///< @param map  of this mesh

  /// @param positions  x y z per particle [m]
  /// @return  one height per vertex [m]
  const std::vector<float>& update(const std::vector<float>& positions);

  /// Stretch across the folds of each particle, as of the last update.
  const std::vector<float>& stretch() const { return stretch_; }

 private:
  /// F t as a combination of two edges of the triangle, and its area at rest.
  struct Strip {
    std::uint32_t corner[3];
    float along_first, along_second;  ///< [1/m]
    float directed;                   ///< 1: the direction is defined
    float area;                       ///< [m^2]
  };

  std::vector<Strip> strips_;
  std::vector<float> area_;  ///< at rest, of the triangles of each particle [m^2]
  std::vector<float> folded_, smooth_;
  std::vector<std::uint32_t> render_offsets_, render_particles_;
  std::vector<float> render_weights_;
  std::vector<float> stretch_, of_particle_, heights_;
};

}  // namespace vibe::graphics
