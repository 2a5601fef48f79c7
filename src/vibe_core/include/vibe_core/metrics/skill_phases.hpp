#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "vibe_core/metrics/force_measures.hpp"
#include "vibe_core/metrics/motion_measures.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

constexpr int kPhaseCount = 5;  ///< see Phase

/// Motion of scope_tip and force on it, in one phase or in a whole session.
struct PhaseSkill {
  double time = 0;        ///< [s]
  MotionMeasures motion;  ///< empty without a tool
  ForceMeasures force;    ///< of the tissue on the tool, mean over each step
};

struct PhasesSkill {
  std::array<PhaseSkill, kPhaseCount> phase;  ///< by Phase; a phase that recurs continues its record
  PhaseSkill whole;                           ///< times, paths and impulses of the phases add up to it
};

/// Measures each phase and the whole session. A step belongs to the phase at its end. A change of phase ends the
/// current movement for the phase but not for the whole session, so the whole may have fewer movements than the sum.
class PhaseRecorder {
 public:
  /// @param spectrum  tables shared by all recorders; used in one thread
  explicit PhaseRecorder(const std::shared_ptr<SpectralArcLength>& spectrum);

  /// @param tip  position at the start, before the first step [m]
  /// @param dt  length of the steps to come [s]
  void start(const Eigen::Vector3d& tip, double dt);

  /// Call after a step. Positions and forces that are not finite are ignored; so is motion without start().
  /// @param tip    in world [m]
  /// @param force  [N]
  void record(Phase phase, const Eigen::Vector3d& tip, double force, double dt);

  const PhasesSkill& measures() const { return measures_; }

 private:
  struct Channel {
    MotionRecorder motion;
    ForceRecorder force;
  };
  void enter(int phase, double dt);

  std::vector<Channel> channel_;  // (phases), and the whole last
  PhasesSkill measures_;
  bool moves_ = false;  // start() was called
  int present_ = -1;    // the phase whose motion is recorded
  Eigen::Vector3d last_tip_ = Eigen::Vector3d::Zero();
};

}  // namespace vibe
