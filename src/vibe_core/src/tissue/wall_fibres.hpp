#pragma once

#include <vector>

#include "tissue/shell.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// The fibres of an organ's wall. Its long axis is that of a stomach (see findAxis), and for an organ without an end at
/// the duodenum the line from its fundus to its pylorus.
/// @param factor  of the modulus, per triangle [1]
/// @throws Error if the organ has no axis: fundus and pylorus are one point
ShellFibres wallFibres(const FibreScene& scene, const Organ& organ, const std::vector<double>& factor);

}  // namespace vibe
