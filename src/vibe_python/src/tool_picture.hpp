#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::python {

/// Labels of what is not wall, after those of the five regions.
constexpr std::uint8_t kToolLabel = 6, kThreadLabel = 7;

/// The wall with the instruments in it, as one surface in world.
struct Scenery {
  std::vector<double> x, y, z;                ///< (vertices), those of the wall first [m]
  std::vector<std::array<int, 3>> triangles;  ///< those of the wall first
  std::vector<std::uint8_t> label;            ///< of each triangle that is not of the wall
  std::vector<Eigen::Vector3d> albedo;        ///< of each vertex that is not of the wall: linear red, green, blue

  SurfaceView surface() const { return {triangles, x, y, z}; }
};

enum class Instruments { None, BeforeTheLens, All };

/// The wall, the meshes that the URDF has for links, and the threads: tubes along straight lines from bite to bite, on
/// the inside of the wall. Blood, T-tags and cinches are not among them. Files of meshes are read once per process.
/// @param model  with a tool, unless no instruments are shown
/// @throws Error if a mesh of the URDF cannot be read
Scenery sceneryOf(const Model& model, const State& state, Instruments shown);

}  // namespace vibe::python
