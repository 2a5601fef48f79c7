#pragma once

#include <cstdint>
#include <fstream>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/metrics/session_metrics.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// One row per step for spreadsheets and scripts. Columns: step, time [s], the seven inputs, tip position in world [m],
/// force and torque on the tool in scope_tip [N], [N m], grip force [N], points of contact, particles held, gauge
/// pressure [Pa], volume [m^3], phase of the procedure, bites in the wall, sutures, max tension of a thread [N], blood
/// lost [m^3], events (kinds separated by ';'). The file is there once finish() has been called.
class SessionCsv {
 public:
  /// @param file  "-": standard output
  /// @throws Error if it cannot be written
  explicit SessionCsv(const std::string& file);

  /// The row of a step.
  /// @param state   after the step
  /// @param events  of the step
  /// @throws Error if what was written so far could not be written
  void write(const Model& model, const State& state, const std::vector<Event>& events);
  /// Call after the last row.
  /// @throws Error if not all of it has arrived
  void finish();

 private:
  std::unique_ptr<WholeFile> whole_;  // null: standard output
  std::ofstream file_;                // of whole_, its part()
  std::ostream* out_;
  std::vector<Eigen::Isometry3d> poses_;

  void check() const;
};

/// The text that every program prints at the end of a run: metrics, solver times, real-time factor and, in the last
/// line, the hash of the state. Ends with a newline.
/// @param simulated, wall  seconds since the first step
std::string runSummary(const SessionMetrics& metrics, const DurationHistogram& solver_cpu, int particle_count,
                       double simulated, double wall, std::uint64_t state_hash);

/// 16 hexadecimal digits.
std::string toHex(std::uint64_t value);

}  // namespace vibe
