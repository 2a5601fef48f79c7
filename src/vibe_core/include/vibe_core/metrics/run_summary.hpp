#pragma once
#include <cstdint>
#include <string>

#include "vibe_core/common/step_timer.hpp"
#include "vibe_core/metrics/session_metrics.hpp"

namespace vibe {

/// What every program prints at the end of a run: the metrics, the solver's times, the real-time factor and, in the
/// last line, the state's hash. Ends with a newline.
/// @param simulated, wall  seconds since the first step
std::string runSummary(const SessionMetrics& metrics, const DurationHistogram& solver_cpu, int particle_count,
                       double simulated, double wall, std::uint64_t state_hash);

/// Sixteen hex digits.
std::string toHex(std::uint64_t value);

}  // namespace vibe
