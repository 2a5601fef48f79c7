#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "contact/swept_tool.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

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
/// Mirtich 1996), until a tenth of what the distance from the core is above `floor` at the start is left.
/// @param floor  [m]; a pair that is nearer at the start stays there: fraction 0
ToolApproach approach(const SweptTool& tool, int shape, const SurfacePath& path, const std::array<int, 3>& triangle,
                      double floor);

/// Per shape: it sits on the tip of the scope or on what the tip carries, such as the suturing device.
std::vector<char> shapesOnTip(const ToolModel& tool);

/// Pairs of shapes and triangles whose ways through a step come near each other.
class NearTriangles {
 public:
  struct Pair {
    int shape, triangle;
  };

  /// @param passable  per vertex: the tool passes through the triangles there
  NearTriangles(const SurfaceMesh& surface, const std::vector<char>& passable);

  /// Those that the tool cannot pass.
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  /// All pairs of shapes and triangles() that may come nearer than `reach`, by shape, then triangle. A triangle with a
  /// vertex that is not finite is left out.
  void find(const SweptTool& tool, const SurfacePath& path, double reach, std::vector<Pair>& found);

 private:
  void classify(const Eigen::AlignedBox3d& box, const SurfacePath& path);
  void collectBalls(const SurfacePath& path);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<unsigned char> outside_;  // per vertex, a bit per side of the tool's box beyond which its path lies
  /// A triangle in the tool's box: a ball that holds it at the start, and its longest path.
  struct Ball {
    int triangle;
    Eigen::Vector3d centre;
    double radius, move;
  };
  std::vector<Ball> balls_;
};

}  // namespace vibe
