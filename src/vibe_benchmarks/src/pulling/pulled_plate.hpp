#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "fem/case_model.hpp"
#include "output/result_row.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {

/// One method of pulling.
struct PullWay {
  const char* method;   ///< tissue.model
  const char* pulling;  ///< suture.cinch_model
  int particles;        ///< suture.group_particles
  double strain_limit;  ///< suture.strain_limit
};

/// The plate of a case in the simulator, with one set of two bites at the spots of the cinch in the case.
class PulledPlate {
 public:
  PulledPlate(const CaseModel& plate, const PullWay& way);

  /// Runs a frame in which the cinch draws, unless the strain of the wall has reached the limit.
  /// @return  false if it has
  bool draw();
  void step();
  double milliseconds() const { return 1e3 * simulation_.timer().last_cpu; }  ///< CPU time of the last frame

  double apart() const;    ///< distance of the bites [m]
  double tension() const;  ///< [N]
  MotionView motion();
  const State& state() const { return simulation_.state(); }

 private:
  Suture& set() { return simulation_.editState().procedure.sutures.front(); }
  const Suture& set() const { return state().procedure.sutures.front(); }

  Simulation simulation_;
};

/// Compares the methods of pulling two bites of the slightly domed wall of case 7 together, in the simulator's own
/// steps of 1/60 s: by the thread, by the groups of the prototype, and by a condition on the bites as in the case
/// itself, with the shell and with shape matching. One row per method and distance of the bites (30, 20, 10 mm):
/// motion_error is that of the displacement field and force_error that of the tension, both relative to the finite
/// elements of the case; empty if a method ends before that distance.
/// @param profile  file for the final mid-line of each method; empty: none
std::vector<ResultRow> runPulling(const std::string& profile, std::ostream& log);

}  // namespace vibe::benchmarks
