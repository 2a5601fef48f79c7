#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "contact/tool_approach.hpp"
#include "contact/tool_motion.hpp"
#include "vibe_core/contact/tool_poses.hpp"

namespace vibe {

/// Keeps the tool on its side of the wall, whatever the solver found. A step that starts without a triangle of the wall
/// passing through the core of a tool shape ends without one: the motions of tool and wall are followed together, and
/// where they would meet, the tool stops on its way; where the wall would run into a tool that stands still, the wall
/// stops as well. By induction nothing crosses that did not cross where a session began.
class ToolGuard {
 public:
  /// @param thickness  of the wall per vertex [m]
  /// @param passable   per vertex: the tool passes through the triangles there
  ToolGuard(const ToolModel& tool, const SurfaceMesh& surface, const std::vector<double>& thickness,
            const std::vector<char>& passable);

  /// Parts of their motions that tool and wall can make, 1: all of it.
  struct Free {
    double tool = 1;
    double wall = 1;
  };

  /// @param poses   of the tool; in and out: `end` becomes the pose that the tool reaches
  /// @param motion  of the tool from start to end
  /// @param path    of the wall, of which the caller then takes the free part
  Free keepApart(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path);

 private:
  double freePart(const std::vector<Eigen::Isometry3d>& start, const std::vector<Eigen::Isometry3d>& end,
                  const SurfacePath& path);
  double freePart(const NearTriangles::Pair& pair, const SurfacePath& path) const;

  std::vector<double> thickness_;
  SweptTool tool_;
  NearTriangles near_;
  std::vector<NearTriangles::Pair> pairs_;
};

}  // namespace vibe
