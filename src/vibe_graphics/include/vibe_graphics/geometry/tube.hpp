#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::graphics {

/// A point on the centre line of a tube.
struct TubePoint {
  Eigen::Vector3d place;  ///< [m]
  double radius;          ///< there [m]
  PackedColour colour;    ///< there, blended to the next point
};

/// Appends a tube with round ends along the points. Every vertex has the distance of the local radius from the centre
/// line, also at bends: slight bends are mitred, and at sharp bends the end of one piece is swept round to the start of
/// the next, so that the tube is neither pinched nor bulges. The rings follow the line without twist (parallel
/// transport). Points closer to the previous one than a thousandth of the radius are skipped; if only one point
/// remains, the result is a ball. Without points, nothing is appended.
/// @param points  finite, radius above 0
/// @param sides   of a ring, at least 3
void appendTube(const std::vector<TubePoint>& points, int sides, ColouredShape& shape);

/// The same with one radius [m] and colour.
void appendTube(const std::vector<Eigen::Vector3d>& points, double radius, PackedColour colour, int sides,
                ColouredShape& shape);

/// Appends a ball; radius in metres.
void appendBall(const Eigen::Vector3d& centre, double radius, PackedColour colour, int sides, ColouredShape& shape);

/// A unit vector perpendicular to a unit vector; the result depends on the argument only.
Eigen::Vector3d anyNormal(const Eigen::Vector3d& direction);

}  // namespace vibe::graphics
