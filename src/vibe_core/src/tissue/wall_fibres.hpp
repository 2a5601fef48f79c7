#pragma once

#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

/// Fibres of the wall of an organ. The long axis is that of a stomach (see findAxis); for an organ without an end at
/// the duodenum it is the line from fundus to pylorus.
/// @param factor  of the modulus, per triangle [1]
/// @throws Error if the organ has no axis: fundus and pylorus coincide
ShellFibres wallFibres(const FibreScene& scene, const Organ& organ, const std::vector<double>& factor);

}  // namespace vibe
