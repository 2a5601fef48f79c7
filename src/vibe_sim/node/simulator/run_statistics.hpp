#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <vibe_msgs/SolverStatistics.h>

#include "simulation/timed_simulation.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/model/tissue_solver.hpp"

namespace vibe::sim {

/// What to do when the simulation falls behind the wall clock: the steps cost too much, or the machine has no time for
/// them. A part of a sentence.
/// @param usual, longest  processor time of a step lately [s]
/// @param period          that it simulates [s]
const char* lagRemedy(double usual, double longest, double period);

/// How long the work takes and whether it keeps up with time. The times of the steps themselves are those of
/// Simulation::timer(). Belongs to the stepping thread.
class RunStatistics {
 public:
  StepTimer publish;                   ///< filling and sending messages
  StepTimer total;                     ///< both, and the application of inputs
  std::int64_t steps = 0;              ///< since the start of the process
  std::uint32_t missed_deadlines = 0;  ///< in the window

  /// The stepping begins now; time before does not count.
  void begin(TimedSimulation& simulation);
  void countStep(double period, const StepReport& report);
  bool windowIsOver() const;  ///< one second has passed

  vibe_msgs::SolverStatistics windowMessage(const TimedSimulation& simulation) const;
  vibe_msgs::SolverStatistics wholeMessage(const TimedSimulation& simulation) const;
  /// One line for people: simulated time, phase, speed, solver time.
  std::string progressLine(const TimedSimulation& simulation) const;
  /// Several lines for people at the end; the last is "state hash: <16 hex digits>".
  std::string summary(const TimedSimulation& simulation) const;

  void startWindow(TimedSimulation& simulation);

 private:
  struct Work {                    // of the solver
    double residual = 0;           // largest [m]
    std::uint32_t unfinished = 0;  // steps
  };

  double begin_ = 0;                        // steady time [s]
  double window_begin_ = 0;                 // [s]
  double simulated_ = 0;                    // since begin [s]
  double window_simulated_ = 0;             // [s]
  std::uint32_t all_missed_deadlines_ = 0;  // before the window
  Work window_work_, all_work_;
  std::array<DurationRecord, kStepStages> stages_;  // of the solver

  vibe_msgs::SolverStatistics message(const TimedSimulation& simulation,
                                      DurationHistogram DurationRecord::*which) const;
};

}  // namespace vibe::sim
