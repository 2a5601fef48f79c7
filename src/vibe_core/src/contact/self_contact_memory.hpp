#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "contact/self_contact_paths.hpp"
#include "contact/self_contact_search.hpp"

namespace vibe {

/// Working memory of a SelfContact between the calls of a step.
class SelfContactMemory {
 public:
  SelfContactMemory(const SurfaceMesh& rest, const std::vector<double>& one_wall, double floor)
      : search(rest, one_wall),
        paths(rest.triangles, floor),
        position(rest.vertices),
        end(rest.vertices),
        move(rest.vertices),
        whole(rest.vertices),
        part(rest.vertices.size()),
        length(rest.vertices.size()) {
    for (int k = 0; k < 3; ++k) {
      met[k].assign(rest.vertices.size(), 0);
      speed[k].assign(rest.vertices.size(), 0);
      start[k].assign(rest.vertices.size(), 0);
      searched[k].assign(rest.vertices.size(), 0);
    }
  }
  Eigen::Vector3d at(int node) const { return {start[0][node], start[1][node], start[2][node]}; }

  Eigen::Vector3d speedOf(int node) const { return {speed[0][node], speed[1][node], speed[2][node]}; }

  /// A vertex and a triangle that it may touch.
  struct Approach {
    SelfContactSearch::Near near;
    Eigen::Vector3d away;  ///< from the triangle to the vertex at detect() [m]
  };

  SelfContactSearch search;
  SelfContactPaths paths;
  std::array<std::vector<double>, 3> start, searched,
      met;                                   // positions at detect(), at the last search of each kind [m]
  std::array<std::vector<double>, 3> speed;  // at detect() [m/s]
  std::vector<Approach> near;                // found by the last search
  std::vector<SelfContactSearch::Near> found;
  std::vector<SelfContactPaths::Pair> meetings;      // of triangles, found by the last search
  std::vector<SelfContactPaths::Pair> swept;         // the same, of fast paths
  bool slow = false;                                 // no node moves farther than `meetings` allow
  std::vector<Eigen::Vector3d> position, end, move;  // of a step [m]
  std::vector<Eigen::Vector3d> whole;                // moves before they were shortened [m]
  std::vector<double> part, length;                  // of the whole moves [1], [m]
};

}  // namespace vibe
