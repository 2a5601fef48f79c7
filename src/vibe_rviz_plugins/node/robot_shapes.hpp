#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

/// A visible part of a robot description.
struct RobotShape {
  std::string frame;    ///< link, in whose frame the shape is
  std::string name;     ///< of the link; with "/" and the name of the visual, if it has one
  ColouredShape shape;  ///< the triangles that are drawn [m]
};

/// The visuals of a robot description as the triangles that are drawn, ordered by link. Spheres, cylinders and boxes
/// are tessellated as for drawing; meshes are read with assimp, as rviz does, with the scale of the URDF.
/// @param problems  one sentence for each mesh that cannot be read, and for a description that cannot
std::vector<RobotShape> robotShapes(const std::string& description, std::vector<std::string>& problems);

}  // namespace vibe::rviz_plugins
