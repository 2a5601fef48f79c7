#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/geometry/anatomy.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// The hollow organ at rest: its mid-surface, whose vertices become the particles, and anatomical labels. All vectors
/// below have one entry per vertex.
struct Organ {
  SurfaceMesh surface;            ///< closed, oriented outwards, evenly meshed
  std::vector<Region> region;     ///< part along the length
  std::vector<Wall> wall;         ///< side around the axis
  std::vector<End> end;           ///< whether the vertex belongs to a held end
  std::vector<double> thickness;  ///< wall thickness [m]
  Landmarks landmarks;
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();  ///< entry point of the scope: centre of the oesophagus end [m]
  Eigen::Vector3d entry_axis = -Eigen::Vector3d::UnitZ();  ///< unit vector from entry into the lumen
};

}  // namespace vibe
