#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "self_contact/self_contact_bounds.hpp"
#include "self_contact/self_contact_close.hpp"
#include "self_contact/self_contact_tree.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Finds parts of a surface that are near in space but not along it. Keeps lists of what may be near, and renews the
/// parts of the lists that the motion may have changed.
class SelfContactSearch {
 public:
  using NodeVectors = SelfContactBounds::NodeVectors;
  using Meeting = std::array<int, 2>;  ///< two triangles

  struct Near {
    int vertex, triangle;
    float distance;  ///< of the centres of their balls [m]
    bool operator<(const Near& other) const {
      return vertex < other.vertex || (vertex == other.vertex && triangle < other.triangle);
    }
  };
  /// Distances [m], cosine of an angle between normals.
  struct Settings {
    const SurfaceWalls& walls;  ///< outlives the search
    double cosine;              ///< of walls that face each other, at most
    double floor;               ///< of triangles that may not come nearer
    double slack;               ///< motion of a vertex for which the lists hold
    bool carried = false;  ///< it moves as a whole: positions are taken about their mean, so that lists hold longer
  };

  SelfContactSearch(const SurfaceMesh& rest, const Settings& settings);

  /// Makes the lists hold on the straight paths from `start` to `end`, which may be the same arrays; the last call must
  /// have ended at `start` or passed there.
  /// @param distance  for near() [m]
  /// @returns false if a position is not finite
  bool adapt(const NodeVectors& start, const NodeVectors& end, double distance);

  /// All vertices and triangles of different walls that may be nearer than the distance and face each other at a time:
  /// the cosine between the normals of the triangle and of some triangle at the vertex is below that of the settings.
  /// Ascending; with others.
  const std::vector<Near>& near() const { return near_; }
  /// All pairs of triangles without a common edge that may come nearer than the floor, ascending; with others. Small
  /// parts without overhang do not come near themselves.
  const std::vector<Meeting>& meetings() const { return meetings_; }
  /// Prepares leastDistance() for positions for which the lists hold.
  void measure(const NodeVectors& where);
  /// No more than the distance of a vertex from a triangle that is near() [m].
  float leastDistance(const Near& near) const {
    return near.distance - vertex_off_[near.vertex] - triangle_off_[near.triangle];
  }

  const VertexTriangles& rings() const { return rings_; }
  int count() const { return count_; }  ///< of the calls of adapt() that had to renew parts of the lists

 private:
  using Positions = std::array<std::vector<double>, 3>;
  static NodeVectors aboutMiddle(const NodeVectors& at, Positions& out);
  bool renew(const NodeVectors& start, const NodeVectors& end, double distance);
  void renewNear();
  void addNear(int vertex, int triangle);
  void renewMeetings();
  bool mayMeet(int one, int other) const;
  bool apart(int one, int other, double distance) const;
  double radius(int triangle) const;

  std::vector<std::array<int, 3>> triangles_;
  const SurfaceWalls& walls_;
  double cosine_, floor_;
  bool carried_;
  Positions middle_start_, middle_end_;  // about their mean; empty unless carried [m]
  VertexTriangles rings_;
  SelfContactTree tree_;
  SelfContactBounds bounds_;
  double distance_ = -1;  // for which near_ holds; < 0: both lists are to be made [m]
  int count_ = 0;
  std::vector<float> vertex_off_, triangle_off_;  // from the centres of the balls in measure() [m]
  std::vector<Near> near_, new_near_, old_near_;
  std::vector<Meeting> meetings_, new_meetings_, old_meetings_;
};

}  // namespace vibe
