#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "tool/tool_motion.hpp"
#include "tool_contact/near_triangles.hpp"
#include "tool_contact/needle_passage.hpp"
#include "tool_contact/tool_approach.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// Keeps the tool on its side of the wall, whatever the solver found. A step that starts without a triangle of the wall
/// passing through the core of a tool shape ends without one: the motions of tool and wall are followed together, and
/// where they would meet, the tool stops on its way; where the wall would run into a tool that stands still, the wall
/// stops as well. What stops the tool does not stop each of its joints: those go on whose own motion is free, so that a
/// tool that is stuck gets free when the hand moves back. By induction nothing crosses that did not cross where a
/// session began.
///
/// A shape with the radius R around its core, and a triangle whose corners have the thickness t at least, keep the
/// floor
///   f = R + min(guard_kept t, b (d - R))  where d > R,  f = guard_nearer d  where d <= R
///   d   distance of the triangle from the core at the start of the step [m]
///   b   guard_nearer; hardly below 1 where d - R < guard_least t, so that the distance never becomes 0
/// along their ways (approach(), conservative advancement, Mirtich 1996). The tool goes guard_taken of its free part.
class ToolGuard {
 public:
  /// @param thickness  of the wall per vertex [m]
  /// @param passable   per vertex: the tool passes through the triangles there
  ToolGuard(const ToolModel& tool, const SurfaceMesh& surface, const std::vector<double>& thickness,
            const std::vector<char>& passable);

  /// Stops the tool on its way where it would meet the wall, up to where both stay apart on their common way.
  /// @returns whether it stops
  bool stop(ToolPoses& poses, ToolMotion& motion, const SurfacePath& path, const std::vector<int>& held);

  /// Stops the tool, and the wall where that is not enough, up to where both stay apart on their common way.
  /// @param poses   of the tool; in and out: `end` becomes the pose that the tool reaches
  /// @param motion  of the tool from start to end; in and out: that to the pose that it reaches
  /// @param path    of the wall
  /// @param held    vertices that the helix holds. It draws triangles there into the device, which are no
  ///                obstacle for what sits on the tip of the scope
  /// @returns the part of its path that the wall can go, 1: all of it
  double separate(ToolPoses& poses, ToolMotion& motion, const SurfacePath& path, const std::vector<int>& held);

  /// The vertices of the triangles that the tool would meet, in ascending order; valid until the next call.
  const std::vector<int>& meets(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path,
                                const std::vector<int>& held);

  /// A vertex of the triangle that has stopped the tool last; -1: none has.
  int blockingVertex() const { return blocking_vertex_; }

 private:
  void findPairs(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path);
  bool isFree(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path);
  double freePart(ToolPoses& poses, const ToolMotion& motion, const SurfacePath& path);
  void moveJoints(ToolPoses& poses, const ToolMotion& wanted, const SurfacePath& path, ToolMotion& motion);
  double freePart(const NearTriangles::Pair& pair, const SurfacePath& path) const;

  bool isDrawnIn(const NearTriangles::Pair& pair) const;

  int blocking_vertex_ = -1, worst_ = -1;  // the latter: of the last freePart()
  const StepPolicy& policy_;
  std::vector<double> thickness_;
  std::vector<char> on_tip_;  // per shape
  std::vector<int> held_;     // vertices
  std::vector<int> met_;
  SweptTool tool_;
  NearTriangles near_;
  NeedlePassage passage_;
  std::vector<NearTriangles::Pair> pairs_;
};

}  // namespace vibe
