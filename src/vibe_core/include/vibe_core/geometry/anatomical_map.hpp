#pragma once
#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "vibe_core/geometry/organ.hpp"

namespace vibe {

class TriangleTree;

/// A point of the wall that moves with the tissue.
struct WallPoint {
  int triangle = -1;                                           ///< of Organ::surface
  Eigen::Vector3d weight = Eigen::Vector3d::Constant(1. / 3);  ///< of its corners, sum 1
};

/// Its position on vertices at present positions [m].
Eigen::Vector3d positionOf(const WallPoint& point, const std::vector<std::array<int, 3>>& triangles,
                           const std::vector<Eigen::Vector3d>& vertices);

/// Unit vector out of the lumen there, mean over the wall within 6 mm; walls of a fold that face the other way do not
/// count.
Eigen::Vector3d outwardAt(const WallPoint& point, const std::vector<std::array<int, 3>>& triangles,
                          const std::vector<Eigen::Vector3d>& vertices);

/// The nearest point of one triangle, with the corners a, b, c [m], to a place.
WallPoint nearestIn(int triangle, const Eigen::Vector3d& place, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    const Eigen::Vector3d& c);

/// The nearest point of the wall to a place, on the side of the wall on which another point lies.
WallPoint nearestOn(const Eigen::Vector3d& place, const WallPoint& same_side,
                    const std::vector<std::array<int, 3>>& triangles, const std::vector<Eigen::Vector3d>& vertices);

/// Anatomical coordinates of a stomach in its present shape: along its axis, around it, and in metres along its wall.
/// They are continuous on the wall, and another mesh of the same organ gives nearly the same places: with 3,000
/// vertices to 1 mm in the mean, with 300 to 2.5 mm, beside the opening of the oesophagus to 5 mm. Making one takes 14
/// ms of an EPYC for 3,618 vertices (the axis), and up to 40 ms for fewer than 3,500, whose surface is divided before.
class AnatomicalMap {
 public:
  /// @param organ     rest shape and landmarks
  /// @param vertices  present positions, one per vertex of the organ [m]
  /// @throws Error if the organ has no oesophagus, no duodenum, another number of vertices, or no axis can be found
  AnatomicalMap(const Organ& organ, std::vector<Eigen::Vector3d> vertices);

  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }  ///< as given to the constructor [m]
  /// Position along the axis of a share of a region, from the fundus towards the pylorus: between its borders on the
  /// greater curvature, or between its farthest vertices where it has none there, as the cardia. 0: its proximal end,
  /// 1: its distal end
  /// @throws Error if the organ lacks the region
  double alongIn(Region region, double share) const;
  double axisLength() const { return axis_length_; }  ///< from the apex of the fundus to the duodenum [m]

  /// The wall at a place.
  /// @param along   position along the axis, 0: apex of the fundus, 1: duodenal end
  /// @param around  angle from the greater curvature, positive towards the anterior wall [rad]
  /// @throws Error outside of 0 to 1, and in the opening of oesophagus and duodenum
  WallPoint at(double along, double around) const;
  /// The point reached from another one along the wall: first distally, then towards the front. Negative distances go
  /// proximally and to the back. [m]
  /// @throws Error if the way leads into an end of the organ, over the apex of the fundus, or more than half around it
  WallPoint walk(const WallPoint& from, double distal, double anterior) const;

  double along(const WallPoint& point) const;              ///< see at()
  double around(const WallPoint& point) const;             ///< see at(), -pi to pi [rad]
  Eigen::Vector3d position(const WallPoint& point) const;  ///< [m]
  Eigen::Vector3d outward(const WallPoint& point) const;   ///< see outwardAt()
  /// Components of a displacement along the wall at a point: distal, anterior [m].
  Eigen::Vector2d alongWall(const WallPoint& point, const Eigen::Vector3d& displacement) const;
  /// The point of the wall at a vertex.
  WallPoint atVertex(int vertex) const;

 private:
  enum class Way { Distal, Anterior };

  WallPoint walkStraight(WallPoint from, double distance, Way way) const;
  Eigen::Vector3d direction(const WallPoint& point, Way way) const;
  WallPoint nearest(const Eigen::Vector3d& place, int around_triangle) const;
  void findDirections();
  void findRegions(const Organ& organ);
  double alongLandmark(const Eigen::Vector3d& landmark, const TriangleTree& rest) const;
  double alongAtHeight(double height, double incisura, const std::vector<Eigen::Vector3d>& rest) const;
  bool inEnd(int triangle) const;

  const std::vector<std::array<int, 3>>& triangles_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::vector<int>> triangles_at_;                  // of each vertex
  std::vector<Eigen::Vector3d> distal_, outward_;               // unit vectors at the vertices
  std::vector<double> along_, around_;                          // per vertex: ratio, [rad]
  std::array<std::pair<double, double>, kRegionCount> extent_;  // along the axis; empty: the first is larger (ratio)
  std::vector<bool> end_;                                       // per vertex: oesophagus or duodenum
  double axis_length_ = 0;
};

}  // namespace vibe
