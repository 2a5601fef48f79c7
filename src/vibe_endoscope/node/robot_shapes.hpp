#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::endoscope {

/// One <visual> of a robot description.
struct RobotVisual {
  std::string link;  ///< in whose frame it is
  std::string part;  ///< name of the link; with "/" and the name of the visual, if it has one
  graphics::ColouredShape
      body;          ///< a sphere, cylinder or box as triangles, in the frame of the link [m]; empty for a mesh
  std::string mesh;  ///< address of a mesh file (package://, file:// or a path); empty for such a body
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the mesh in the frame of the link [m]
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();         ///< of the mesh, before the pose
};

/// All visuals of a robot description, ordered by the names of their links. Bodies have the colour of their material,
/// without one a grey.
/// @param description  URDF
/// @return empty if it cannot be read
std::optional<std::vector<RobotVisual>> robotVisuals(const std::string& description);

/// A visible part of a robot description.
struct RobotShape {
  std::string frame;              ///< link, in whose frame the shape is
  std::string name;               ///< of the link; with "/" and the name of the visual, if it has one
  graphics::ColouredShape shape;  ///< the triangles that are drawn [m]
};

/// The visuals of a robot description as the triangles that are drawn, ordered by link. Spheres, cylinders and boxes
/// are tessellated as for drawing; meshes are read with assimp, as rviz does, with the scale of the URDF.
/// @param problems  one sentence for each mesh that cannot be read, and for a description that cannot
std::vector<RobotShape> robotShapes(const std::string& description, std::vector<std::string>& problems);

}  // namespace vibe::endoscope
