#pragma once
#include <Eigen/Geometry>

#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

// Appends the bodies of robot descriptions to a shape, centred at the pose, a cylinder along its z axis. All lengths
// are in metres and positive.

void appendSphere(const Eigen::Isometry3d& pose, double radius, PackedColour colour, ColouredShape& shape);
void appendCylinder(const Eigen::Isometry3d& pose, double radius, double length, PackedColour colour,
                    ColouredShape& shape);
/// @param size  of the edges along x, y and z
void appendBox(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, PackedColour colour, ColouredShape& shape);

}  // namespace vibe::rviz_plugins
