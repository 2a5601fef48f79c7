#pragma once
#include <cstdint>
#include <string>

#include "vibe_core/common/step_timer.hpp"
#include "vibe_core/metrics/session_metrics.hpp"

namespace vibe {

/// The text that every program prints at the end of a run: metrics, solver times, real-time factor and, in the last
/// line, the hash of the state. Ends with a newline.
/// @param simulated, wall  seconds since the first step
std::string runSummary(const SessionMetrics& metrics, const DurationHistogram& solver_cpu, int particle_count,
                       double simulated, double wall, std::uint64_t state_hash);

/// 16 hexadecimal digits.
std::string toHex(std::uint64_t value);

}  // namespace vibe
