#pragma once
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::prototype {

/// Finds the group of a set whose technique is recognised: all of indexGroups(), with the whole legs of a U.
/// @throws vibe::Error  as indexGroups() does
void findGroup(const Model& model, const State& state, Suture& suture);

/// Greatest change of length, lengthening or shortening, of the sides of triangles at the group's particles, over their
/// length at rest. Compared with scene.suture->strain_limit it stands for the elastic limit.
double groupStrain(const Model& model, const State& state, const TissueGroup& group);

/// Draws the farthest particle of a set's group `amount` nearer to the middle, the others by the same part [m].
/// @return what was drawn, less where they have arrived [m]
double drawGroup(double amount, Suture& suture);

/// Where a group's middle is [m].
Eigen::Vector3d middleOf(const TissueGroup& group, const State& state);

/// The springs become as long as they are: for tissue that was put back to rest.
void slackenGroup(const State& state, TissueGroup& group);

}  // namespace vibe::prototype
