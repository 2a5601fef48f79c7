#pragma once
#include <Eigen/Geometry>
#include <array>
#include <initializer_list>
#include <vector>

#include "tool_contact/near_triangles.hpp"
#include "tool_contact/needle_passage.hpp"
#include "tool_contact/tool_approach.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

/// Mark of a vertex that the helix holds, see SurfaceContacts::find().
constexpr char kHeld = 2;

/// Per vertex: the tool passes through the triangles there. The ends are open where the organ goes on: the scope passes
/// through their closing surface.
std::vector<char> passableVertices(const Organ& organ);

/// A point of the wall that a tool shape touches or may reach within the step.
struct SurfaceContact {
  SurfacePoint point;
  int shape = -1;          ///< of the tool
  bool nearest = false;    ///< the nearest point of a triangle: it moves with the tilt of the triangle
  double clearance = 0;    ///< distance of the mid-surface from the shape where it touches: half the wall, or less [m]
  double distance = 0;     ///< of the mid-surface from the shape when `normal` was taken [m]
  Eigen::Vector3d normal;  ///< unit, out of the shape, as the shape is turned at the end of the step
  Eigen::Vector3d tool_point;                       ///< of the shape's surface, at the end of the step [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< of the last step, if known [N]
};

/// Contacts of a tool with the triangles of a wall, continuous in time and in the state: a contact that comes or goes
/// has no force, so that a wall that is held can come to rest. A normal is that of a point at the moment of the step at
/// which its forces act, if nothing stops it; or it is taken just before the wall would pass through the shape, so that
/// wall and tool keep their sides however fast they move.
///
/// Contacts are points of the wall that stay the same from step to step: the vertices, and where these leave room for
/// the shape between them, because it is thin or the triangles are large, points that divide edges and triangles
/// evenly: into the parts of the usual stretch, and into twice, four times as many where they are stretched more, where
/// the added points begin with what the others leave. A shape wider than the triangles therefore has one contact per
/// vertex within reach. The nearest points of a triangle and a shape would be fewer, but they move with the tilt of the
/// triangle, and a force that follows that from step to step does not come to rest. Where two shapes touch one point,
/// both contacts count: between shapes that meet at an angle the wall rests against both, and each alone would push it
/// to the other. One that is farther than the nearest by touch_beside does not, unless the point would go through it.
///
/// A contact asks of its point p, with the shape's point q, the normal n and the clearance c,
///   n . (p - q) >= c,  n along (1 - w) d0 n0 + w d1 n1
///   c       half the wall; less where a point divides what is stretched, and in corners of the tool [m]
///   d, n    distance of p from the core of the shape, and the direction out of it, at the start (0) and the end (1)
///   w       the moment at which the forces of the step act, as a part of it (Gonzalez 1996; docs/computation.md, (10))
/// Points of a spacing s that keep R + h from the core of a shape keep the wall between them, with h = half the wall,
///   sqrt((R + h)^2 - s^2 / 3) >= R + touch_kept_between h
/// from it, because the square of the distance from a convex set grows no faster than that from a point.
class SurfaceContacts {
 public:
  /// @param thickness  of the wall per vertex [m]
  /// @param passable   per vertex: the tool passes through the triangles there
  SurfaceContacts(const ToolModel& tool, const SurfaceMesh& surface, const std::vector<double>& thickness,
                  const std::vector<char>& passable);

  /// @param start, end  pose of every link in world
  /// @param path    vertices at the start of the step, and at its end if nothing stops them
  /// @param margin  contacts are those that come nearer to touching than this [m]
  /// @param excluded  per vertex: 1: it takes no part; a triangle of only such vertices neither; kHeld: the helix holds
  ///                  it, and draws triangles there into the device on the tip of the scope
  /// @param when    part of the step after which its forces act
  /// @param needle_leads  the needle is on the arm, see NeedlePassage
  /// @returns ordered by nodes, then depth; valid until the next call
  const std::vector<SurfaceContact>& find(const std::vector<Eigen::Isometry3d>& start,
                                          const std::vector<Eigen::Isometry3d>& end, const SurfacePath& path,
                                          double margin, const std::vector<char>& excluded, double when = 1,
                                          bool needle_leads = false);

  /// The triangles that the tool cannot pass.
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

 private:
  struct Pair {
    int triangle;
    ToolApproach approach;
  };
  // Of an edge, or of all edges of a triangle, into even parts.
  struct Division {
    int parts = 1;
    double share = 1;  // of their distance that points keep which halve what was a part with less stretch
  };
  double halfThickness(const std::array<int, 3>& node, const Eigen::Vector3d& weight) const;
  void followPairs(const SurfacePath& path, double margin, std::size_t first, std::size_t last);
  void addVertices(const SurfacePath& path, double margin, int shape, const std::vector<char>& excluded);
  bool isDrawnIn(int shape, std::initializer_list<int> vertices, const std::vector<char>& excluded) const;
  void addBetween(const SurfacePath& path, double margin, int shape, const std::vector<char>& excluded);
  void addNearest(int shape, const std::vector<char>& excluded);
  double spacing(int shape, double half) const;
  Division divide(double rest, double length, double spacing) const;
  void addEdge(const SurfacePath& path, double margin, int shape, const Pair& pair, int edge, const Division& division);
  void addInterior(const SurfacePath& path, double margin, int shape, const Pair& pair, const Division& division);
  void offer(const SurfacePoint& point, const SurfacePath& path, int shape, bool hit, double margin, double share = 1);
  void add(const SurfacePoint& point, int shape, double fraction, const TriangleGap& gap, double clearance,
           bool nearest = false);
  void addAlong(const SurfacePoint& point, int shape, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                const TriangleGap& gap, double clearance);
  void addOutside(SurfaceContact& contact, const Eigen::Vector3d& wall, const Eigen::Vector3d& core);
  bool isLeftTo(int other, int shape, const Eigen::Vector3d& wall, const Eigen::Vector3d& core) const;
  bool goesOnInto(int other, int shape, const Eigen::Vector3d& core) const;
  Eigen::Vector3d inwards(int shape, const Eigen::Vector3d& end) const;
  void removeBeside();

  const StepPolicy& policy_;
  SweptTool tool_;
  std::vector<char> on_tip_;  // per shape
  NearTriangles near_triangles_;
  NeedlePassage passage_;
  const std::vector<std::array<int, 3>>& triangles_;
  std::vector<std::array<int, 3>> neighbour_;  // of each triangle across the edge after its k-th vertex, -1: none
  std::vector<double> half_thickness_;         // per vertex
  double max_half_thickness_ = 0;
  std::vector<std::array<double, 3>> length_;  // of the triangles' edges at rest [m]
  std::vector<NearTriangles::Pair> near_;
  std::vector<Pair> pairs_;    // of the shape in turn
  std::vector<int> vertices_;  // of those
  std::vector<char> hit_;      // per vertex: the shape would pass through one of its triangles
  double when_ = 1;
  double fraction_ = 1;               // up to which the shape in turn and all triangles stay apart
  std::vector<int> stamp_, pair_of_;  // per vertex; per triangle, -1: none
  int count_ = 0;
  std::vector<SurfaceContact> contacts_, kept_;
};

}  // namespace vibe
