#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "ray_caster.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::python {

/// Distance at which a white wall that faces the endoscope's lamp has the radiance 1 [m].
constexpr double kLampReach = 0.03;

/// Linear red, green and blue of every particle: of its region, lighter and darker from particle to particle so that
/// motion shows, and of what the argon beam has left.
std::vector<Eigen::Vector3d> wallAlbedo(const Model& model, const State& state);

/// Shades what castRays() has found, as a matt wall with smooth normals that a small lamp at the lens lights:
///   radiance r = albedo cos(angle between normal and lamp) (lamp / distance)^2, shown as 255 sqrt(r / (1 + r)).
/// Nearer than 10 mm light goes through the wall, too, and it becomes red, as in the endoscope's picture
/// (docs/endoscope_look.md). There are no shadows, because what the lens sees, the lamp lights. All operations are
/// rounded by IEEE 754.
/// @param walls  the first so many triangles are wall; light does not go through the others
/// @param lamp  distance at which a white wall that faces it has the radiance 1 [m]
/// @param[out] colour  (height, width, 3)
void shade(const SurfaceView& surface, int walls, const std::vector<Eigen::Vector3d>& albedo,
           const Eigen::Isometry3d& camera, double field_of_view, double lamp, const CastImage& image,
           std::uint8_t* colour);

}  // namespace vibe::python
