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
      : search(rest, one_wall), paths(rest.triangles, search, floor), position(rest.vertices), move(rest.vertices) {
    for (int k = 0; k < 3; ++k) {
      start[k].assign(rest.vertices.size(), 0);
      searched[k].assign(rest.vertices.size(), 0);
    }
  }
  Eigen::Vector3d at(int node) const { return {start[0][node], start[1][node], start[2][node]}; }

  SelfContactSearch search;
  SelfContactPaths paths;
  std::array<std::vector<double>, 3> start, searched;  // positions at detect(), at the last search [m]
  std::vector<SelfContactPaths::Approach> near;        // found by the last search, `away` as at detect()
  std::vector<SelfContactPaths::Approach> approaches;
  std::vector<SelfContactSearch::Near> found;
  std::vector<Eigen::Vector3d> position, move, whole;  // over a part of a step; `whole`: before shortening [m]
  std::vector<char> stopped;
};

}  // namespace vibe
