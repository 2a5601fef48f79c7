#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace vibe {

/// Stiffness between up to six nodes (two bites of three) beside that of the elements, such as a contact or a tense
/// thread: it adds the block weight[i] * weight[j] * stiffness between the nodes i and j. It may couple nodes that no
/// element couples.
struct StiffnessCoupling {
  std::array<int, 6> node{-1, -1, -1, -1, -1, -1};  ///< -1: unused
  std::array<float, 6> weight{};                    ///< ratio
  std::array<float, 6> stiffness{};                 ///< symmetric, positive semidefinite: xx, xy, xz, yy, yz, zz [N/m]
};

/// What an implicit stepper carries from step to step beside the motion. The factor itself is a cache: it is computed
/// again wherever the scratch does not hold the one that the memory names.
struct StepperMemory {
  /// Positions of the factor in use (3 * nodes), of a driven body less its mean move [m], and after them, where muscle
  /// contracts, its contraction (nodes); empty: rest.
  std::vector<float> linearization_point;
  std::vector<float> next;                        ///< the same of the next factor; empty: there is none
  std::vector<StiffnessCoupling> couplings;       ///< contacts and threads in the factor in use
  std::vector<StiffnessCoupling> next_couplings;  ///< the same of the next factor
  std::uint64_t linearization_id = 0;             ///< hash of `linearization_point` and `couplings`
  std::uint64_t next_id = 0;                      ///< hash of `next` and `next_couplings`
  std::int64_t steps = 0;                         ///< number of steps taken
  std::int64_t due = 0;                           ///< value of `steps` at which the next factor takes over
  double elastic_energy = 0;     ///< of elements and foundation at the end of the last step; < 0: unknown [J]
  double usual_length = 0;       ///< running mean of the first moves of steps [m]
  int rest_steps = 0;            ///< consecutive steps in which nothing moved
  int recovery_steps = 0;        ///< that remain of a recovery, straight to rest
  int jammed_steps = 0;          ///< in which walls were jammed, less those in which they were not; 0 or more
  int backward_euler_steps = 0;  ///< that remain since a step that did not arrive, and begin anew with the next
};

}  // namespace vibe
