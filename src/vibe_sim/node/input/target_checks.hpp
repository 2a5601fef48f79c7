#pragma once
#include <string>

#include "input/input_sample.hpp"
#include "vibe_core/model/model.hpp"

// What a sample asks for, compared with what there is: no slip of a hand is as large, another unit or frame is.

namespace vibe::sim {

/// Why a sample is refused, in one sentence; empty: it is not. A place of the tip is refused at more than three times
/// the reach of the scope from its base, a velocity at more than that per second or three times the speed of the
/// rotation, and a target of the pull spring at more than three times the size of the organ from the particle. A
/// particle that does not exist is not found out here.
std::string refusalOf(const InputSample& sample, const Model& model);

/// One sentence about a joint that is asked to go beyond its limits by a tenth of its range and more, and goes to the
/// limit; empty: none is.
std::string beyondLimits(const InputSample& sample, const Model& model);

}  // namespace vibe::sim
