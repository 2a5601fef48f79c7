#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace vibe::test {

struct TetBox {
  std::vector<Eigen::Vector3d> nodes;        ///< [m]
  std::vector<std::array<int, 4>> elements;  ///< node numbers; from node 3, 0 1 2 are counter-clockwise
};

/// A box of cubes with the given number along each axis, cut into six tetrahedra each (Kuhn's division).
/// @param side  of a cube [m]
inline TetBox kuhnBox(std::array<int, 3> cubes, double side) {
  TetBox box;
  const auto number = [&](const std::array<int, 3>& at) {
    return (at[0] * (cubes[1] + 1) + at[1]) * (cubes[2] + 1) + at[2];
  };
  std::array<int, 3> c;
  for (c[0] = 0; c[0] <= cubes[0]; ++c[0])
    for (c[1] = 0; c[1] <= cubes[1]; ++c[1])
      for (c[2] = 0; c[2] <= cubes[2]; ++c[2]) box.nodes.push_back(side * Eigen::Vector3d(c[0], c[1], c[2]));
  for (c[0] = 0; c[0] < cubes[0]; ++c[0])
    for (c[1] = 0; c[1] < cubes[1]; ++c[1])
      for (c[2] = 0; c[2] < cubes[2]; ++c[2]) {
        std::array<std::size_t, 3> axes = {0, 1, 2};
        do {
          std::array<int, 3> at = c;
          std::array<int, 4> element = {number(at), 0, 0, 0};
          for (std::size_t k = 0; k < 3; ++k) ++at[axes[k]], element[k + 1] = number(at);
          const bool odd = (axes[0] > axes[1]) ^ (axes[0] > axes[2]) ^ (axes[1] > axes[2]);
          if (odd) std::swap(element[2], element[3]);
          box.elements.push_back(element);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  return box;
}

}  // namespace vibe::test
