#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "contact/contact_run.hpp"

namespace vibe::benchmarks {

/// Short motions in which the numbers of the policy act: the wall pressed, swept along and rammed by the scope, a fold
/// that is wound in, one that meets others while the gas leaves, a set that is cinched.
/// @param scene  with gas, scope, helix and suture; coarse, so that a run takes a second or two
/// @param urdf   text of the scene's tool
std::vector<ContactCase> policyStates(const Scene& scene, const std::string& urdf, std::ostream& log);

/// Names of the states, one line each, for the program's help.
std::string describePolicyStates();

}  // namespace vibe::benchmarks
