#pragma once

#include <string>

#include "vibe_core/model/model.hpp"

namespace vibe {

/// One sentence if the scope is so wide that the open end through which it enters, which the scene holds, hardly
/// stretches around it, otherwise empty. A scope that is somewhat wider than the end stretches it and passes.
std::string fitWarning(const Model& model);

}  // namespace vibe
