#include "vibe_core/metrics/run_summary.hpp"

#include <cinttypes>
#include <cstdio>

namespace vibe {

std::string toHex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, value);
  return text;
}

std::string runSummary(const SessionMetrics& metrics, const DurationHistogram& solver_cpu, int particle_count,
                       double simulated, double wall, std::uint64_t state_hash) {
  char text[256];
  std::snprintf(text, sizeof text,
                "solver per step    %8.2f ms p50   %.2f ms p99   %.2f ms max of CPU time, %" PRIu64
                " steps of %d particles\n"
                "real-time factor   %8.2f\n",
                1e3 * solver_cpu.quantile(0.5), 1e3 * solver_cpu.quantile(0.99), 1e3 * solver_cpu.max(),
                solver_cpu.count(), particle_count, wall > 0 ? simulated / wall : 0.0);
  return summarise(metrics) + "\n" + text + "state hash: " + toHex(state_hash) + "\n";
}

}  // namespace vibe
