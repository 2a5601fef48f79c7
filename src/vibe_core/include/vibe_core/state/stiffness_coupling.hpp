#pragma once

#include <Eigen/Core>
#include <array>

namespace vibe {

/// Stiffness between up to six nodes (two bites of three) beside that of the elements, such as a contact or a tense
/// thread: it adds the block weight[i] * weight[j] * stiffness between the nodes i and j. It may couple nodes that no
/// element couples.
struct StiffnessCoupling {
  std::array<int, 6> node{-1, -1, -1, -1, -1, -1};  ///< -1: unused
  std::array<float, 6> weight{};                    ///< [1]
  std::array<float, 6> stiffness{};                 ///< symmetric, positive semidefinite: xx, xy, xz, yy, yz, zz [N/m]
};

}  // namespace vibe
