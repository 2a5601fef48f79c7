#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "tool_contact/shape_distance.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// The shapes of the tool along a step. Between its start and its end every shape moves along a straight line and turns
/// about a fixed axis; the joints' true path differs by the square of the angle of a step. A shape is its core, grown
/// by its radius: a point for spheres, a segment for capsules, the shape itself without a radius for others.
class SweptTool {
 public:
  /// @param model  must outlive this object
  explicit SweptTool(const ToolModel& model);

  /// @param start, end  pose of every link in world
  void place(const std::vector<Eigen::Isometry3d>& start, const std::vector<Eigen::Isometry3d>& end);

  int count() const { return static_cast<int>(shapes_.size()); }
  bool hasSegment(int shape) const { return shapes_[shape].round; }  ///< the core is a segment or a point
  /// Its ends at a fraction of the step.
  std::array<Eigen::Vector3d, 2> segment(int shape, double fraction) const;
  double radius(int shape) const { return shapes_[shape].radius; }  ///< [m]
  /// Longest way of a point of the shape, and of all shapes [m].
  double travel(int shape) const { return shapes_[shape].travel; }
  double travel() const { return travel_; }
  /// Box around all of the way of a shape, and of the whole tool.
  const Eigen::AlignedBox3d& box(int shape) const { return shapes_[shape].box; }
  const Eigen::AlignedBox3d& box() const { return box_; }
  /// Displacements of the ends of the core.
  std::array<Eigen::Vector3d, 2> moves(int shape) const;

  /// Nearest points of the core and a triangle, or a point, at a fraction of the step, in world.
  TriangleGap gap(int shape, double fraction, const std::array<Eigen::Vector3d, 3>& triangle) const;
  TriangleGap gap(int shape, double fraction, const Eigen::Vector3d& point) const;
  /// Where a point or a direction of the shape is at the end of the step.
  Eigen::Vector3d pointAtEnd(int shape, double fraction, const Eigen::Vector3d& point) const;
  Eigen::Vector3d directionAtEnd(int shape, double fraction, const Eigen::Vector3d& direction) const;

 private:
  struct Shape {
    const btConvexShape* shape;
    int link;
    Eigen::Isometry3d origin;  // in the link
    bool round = false;        // core is a segment
    double radius = 0;
    std::array<Eigen::Vector3d, 8>
        corner;  // of the core: ends of the segment in the first two, or of the box around it
    int corners = 8;
    Eigen::Isometry3d start, end;
    std::array<Eigen::Vector3d, 2> a, b;  // ends of the core at the start and at the end of the step
    Eigen::Quaterniond turned_from, turned_to;
    double travel = 0;
    Eigen::AlignedBox3d box;
  };
  static Shape shapeOf(const ToolShape& shape);
  static void placeShape(Shape& shape);
  static Eigen::Isometry3d poseAt(const Shape& shape, double fraction);

  std::vector<Shape> shapes_;
  double travel_ = 0;
  Eigen::AlignedBox3d box_;
};

/// Straight paths of the vertices of a surface during a step.
struct SurfacePath {
  std::array<const double*, 3> from{}, to{};  ///< coordinates [m]
  double part = 1;                            ///< of these ways that the vertices go

  Eigen::Vector3d start(int vertex) const { return {from[0][vertex], from[1][vertex], from[2][vertex]}; }
  Eigen::Vector3d at(int vertex, double fraction) const {
    const Eigen::Vector3d end(to[0][vertex], to[1][vertex], to[2][vertex]);
    return start(vertex) + fraction * part * (end - start(vertex));
  }
};

/// A shape and a triangle at the moment in a step up to which they stay apart.
struct ToolApproach {
  double fraction = 1;  ///< of the step
  TriangleGap gap;      ///< then
  TriangleGap start;    ///< at the start of the step
  double nearest = 0;   ///< the smaller of their distances at the start and then [m]
};

/// Follows a shape and a triangle through the step, by steps that their distance permits (conservative advancement,
/// Mirtich 1996), until sweep_kept of what the distance from the core is above `floor` at the start is left.
/// @param floor  [m]; a pair that is nearer at the start stays there: fraction 0
ToolApproach approach(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                      double floor);
/// @param start  what is known already: the gap at the start of the step
ToolApproach approach(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                      double floor, const TriangleGap& start);

/// Whether a shape with a segment and a triangle certainly stay apart: a direction separates them at both ends of the
/// step, and with that throughout.
/// @returns false if approach() might not reach fraction 1, or `nearest` be no more than `least`
bool staysApart(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                double floor, double least);

/// Per shape: it sits on the tip of the scope or on what the tip carries, such as the suturing device.
std::vector<char> shapesOnTip(const ToolModel& tool);

}  // namespace vibe
