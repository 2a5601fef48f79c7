#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::graphics {

/// A point of the outline of a body of revolution: position along the axis and distance from it [m].
using ProfilePoint = Eigen::Vector2d;

/// Appends the body of revolution of a profile about the axis through `origin`. The profile runs so that
/// the outside is on its right when the axis points up and the profile lies to the right of it (from the top down for
/// a closed body such as a ball). A first or last point on the axis closes the body there.
/// @param axis   unit
/// @param sides  around the axis, at least 3
void appendRevolved(const std::vector<ProfilePoint>& profile, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& axis, PackedColour colour, int sides, ColouredShape& shape);

/// Appends a ring (torus) around the axis.
/// @param radius     major radius [m]
/// @param thickness  minor radius [m]
void appendRing(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis, double radius, double thickness,
                PackedColour colour, int sides, ColouredShape& shape);

/// Appends a bobbin (two rims and a waist between them), the shape of the cinch of a suturing device.
/// @param length, rim  total length and radius of the rims [m]
void appendBobbin(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis, double length, double rim,
                  PackedColour colour, int sides, ColouredShape& shape);

// Appends the bodies of robot descriptions to a shape, centred at the pose, a cylinder along its z axis. All lengths
// are in metres and positive.

/// Appends a ball about the origin of the pose. @param radius  [m]
void appendSphere(const Eigen::Isometry3d& pose, double radius, PackedColour colour, ColouredShape& shape);
/// Appends a cylinder along z of the pose, half of it on either side. @param radius, length  [m]
void appendCylinder(const Eigen::Isometry3d& pose, double radius, double length, PackedColour colour,
                    ColouredShape& shape);
/// @param size  of the edges along x, y and z
void appendBox(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, PackedColour colour, ColouredShape& shape);

}  // namespace vibe::graphics
