#pragma once
#include <memory>
#include <string>
#include <vector>

#include "fem/case_model.hpp"
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

}  // namespace vibe::benchmarks
