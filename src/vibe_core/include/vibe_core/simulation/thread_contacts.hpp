#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/state/state.hpp"

namespace vibe {

/// What a thread does to the wall at one of its bites.
struct ThreadContact {
  int suture = -1, bite = -1;  ///< numbers in ProcedureState::sutures and Suture::bites
  Eigen::Vector3d point;       ///< of the wall, world [m]
  Eigen::Vector3d force;       ///< thread on the wall, with the tensions of the last step, world [N]
};

/// Of all threads that pull: at each bite the pulls of the pieces on both sides of it. The forces of a thread add up to
/// zero.
std::vector<ThreadContact> threadContacts(const State& state);

}  // namespace vibe
