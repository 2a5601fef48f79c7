#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "contact/self_contact_close.hpp"
#include "contact/self_contact_paths.hpp"
#include "contact/self_contact_search.hpp"

namespace vibe {

/// Working memory of a SelfContact between the calls of a step.
class SelfContactMemory {
 public:
  /// Distances [m].
  /// @param one_wall  along edges within which the surface is one wall
  /// @param floor     minimum distance of paths
  /// @param slack     motion of a vertex for which what was found holds
  SelfContactMemory(const SurfaceMesh& rest, double one_wall, double cosine, double floor, double slack)
      : walls(rest, one_wall),
        search(rest, {walls, cosine, floor, slack}),
        close(rest.triangles, search.rings(), walls),
        paths(rest.triangles, walls, floor),
        position(rest.vertices),
        move(rest.vertices),
        whole(rest.vertices),
        part(rest.vertices.size()),
        length(rest.vertices.size()) {
    for (auto* vectors : {&speed, &start, &end})
      for (std::vector<double>& component : *vectors) component.assign(rest.vertices.size(), 0);
  }
  Eigen::Vector3d at(int node) const { return {start[0][node], start[1][node], start[2][node]}; }
  Eigen::Vector3d speedOf(int node) const { return {speed[0][node], speed[1][node], speed[2][node]}; }
  static SelfContactSearch::NodeVectors view(const std::array<std::vector<double>, 3>& vectors) {
    return {vectors[0].data(), vectors[1].data(), vectors[2].data()};
  }

  /// A triangle that a vertex may touch.
  struct Approach {
    int triangle;
    Eigen::Vector3d away;  ///< from the triangle to the vertex at detect() [m]
  };

  SurfaceWalls walls;
  SelfContactSearch search;
  SelfContactClose close;
  SelfContactPaths paths;
  std::array<std::vector<double>, 3> start, end;  // positions at detect(), after the step [m]
  std::array<std::vector<double>, 3> speed;       // at detect() [m/s]
  std::vector<Approach> approaches;               // of one vertex
  std::vector<SelfContactClose::Pair> facing;     // triangles that may be close
  std::vector<Eigen::Vector3d> position, move;    // of a step [m]
  std::vector<Eigen::Vector3d> whole;             // moves before they were shortened [m]
  std::vector<double> part, length;               // of the whole moves [1], [m]
};

}  // namespace vibe
