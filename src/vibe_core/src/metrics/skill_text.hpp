#pragma once
#include <string>

#include "vibe_core/metrics/skill_metrics.hpp"

namespace vibe {

/// The metrics as lines of text for people, without a trailing newline; what has no value is '-'.
std::string summarise(const SkillMetrics& metrics);

}  // namespace vibe
