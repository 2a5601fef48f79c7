#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "tool_contact/tool_approach.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Pairs of shapes and triangles whose ways through a step come near each other. Those that may do so while wall and
/// tool move by some tenths of a millimetre are listed, and only they are looked at until that is no longer certain.
/// What is found depends only on the arguments.
class NearTriangles {
 public:
  struct Pair {
    int shape, triangle;
  };

  /// @param passable  per vertex: the tool passes through the triangles there
  NearTriangles(const SurfaceMesh& surface, const std::vector<char>& passable);

  /// The triangles that the tool cannot pass.
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  /// All pairs of shapes and triangles() that may come nearer than `reach`, by shape, then triangle. A triangle with a
  /// vertex that is not finite is left out. Allocates only while its lists grow.
  void find(const SweptTool& tool, const SurfacePath& path, double reach, std::vector<Pair>& found);

  int listings() const { return listings_; }  ///< how often all pairs were looked at

 private:
  /// A ball around a triangle at the start of the step.
  struct Ball {
    int triangle;
    Eigen::Vector3d centre;
    double radius;
    double move;        // longest path of a corner [m]
    int measured;       // call of find() for which it holds
    bool out_of_reach;  // beyond one side of all that the tool may reach
  };
  struct Candidate {
    int shape, ball;
    double apart;  // when listed [m]
  };
  /// Balls that follow each other in the list, and a box around them.
  struct Group {
    std::size_t first, last;
    Eigen::AlignedBox3d box;
  };
  struct ShapePosition {
    std::array<Eigen::Vector3d, 2> segment;
    Eigen::AlignedBox3d box;
  };
  bool holds(const SweptTool& tool, const SurfacePath& path, double reach);
  void list(const SweptTool& tool, const SurfacePath& path, double reach);
  void listBalls(const SweptTool& tool, const SurfacePath& path);
  void listCandidates(const SweptTool& tool, int shape);
  double apart(const SweptTool& tool, int shape, const Ball& ball) const;
  void measure(const Eigen::AlignedBox3d& box, const SurfacePath& path, Ball& ball) const;
  bool isNear(const SweptTool& tool, int shape, const Ball& ball, double reach) const;

  std::vector<std::array<int, 3>> triangles_;
  std::vector<Ball> balls_;  // by triangle, as the next ones of what has been listed
  std::vector<Group> groups_;
  std::vector<Candidate> candidates_;
  std::array<std::vector<double>, 3> wall_;  // where it was when the list was made [m]
  std::vector<ShapePosition> tool_;          // per shape, likewise
  double listed_ = -1;                       // pairs that were nearer are listed [m]
  std::vector<double> needed_;               // per shape: pairs that were farther apart are not near now [m]
  int calls_ = 0, listings_ = 0;
};

}  // namespace vibe
