#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe {

/// A place on the middle line of a tube.
struct TubePoint {
  Eigen::Vector3d place;  ///< [m]
  double radius;          ///< there [m]
  PackedColour colour;
};

/// Appends a tube with round ends along the points. Every vertex is as far from the middle line as the radius there
/// says, also where the line turns: slight turns are mitred, at sharp ones the end of one piece is swept round to the
/// beginning of the next, so that nothing is pinched and nothing sticks out. The rings are carried along without twist
/// (parallel transport). Points nearer to the one before than a thousandth of the radius are left out; where only one
/// place remains it is a ball. Nothing is appended without points.
/// @param points  finite, radius above 0
/// @param sides   of a ring, at least 3
void appendTube(const std::vector<TubePoint>& points, int sides, ColouredShape& shape);

/// The same with one radius [m] and colour.
void appendTube(const std::vector<Eigen::Vector3d>& points, double radius, PackedColour colour, int sides,
                ColouredShape& shape);

/// A ball of the radius [m].
void appendBall(const Eigen::Vector3d& centre, double radius, PackedColour colour, int sides, ColouredShape& shape);

/// A unit vector at right angles to a unit vector, always the same for the same one.
Eigen::Vector3d anyNormal(const Eigen::Vector3d& direction);

}  // namespace vibe
