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

/// How scope_tip moved and what tissue did to it, in one phase or in a whole session.
struct PhaseSkill {
  double time = 0;        ///< [s]
  MotionMeasures motion;  ///< nothing without a tool
  ForceMeasures force;    ///< of the tissue on the tool, mean over each step
};

struct PhasesSkill {
  std::array<PhaseSkill, kPhaseCount> phase;  ///< by Phase; a phase that comes back goes on
  PhaseSkill whole;                           ///< the phases' times, paths and impulses add up to it
};

/// Measures every phase by itself and the whole. A step belongs to the phase at its end. The change of phase ends the
/// movement under way for the phase, not for the whole, whose counts of movements may so be less than the sum.
class PhaseRecorder {
 public:
  /// @param spectrum  tables shared by all recorders; used in one thread
  explicit PhaseRecorder(const std::shared_ptr<SpectralArcLength>& spectrum);

  /// Where the tip is at the start, before the first step.
  /// @param dt  length of the steps to come [s]
  void start(const Eigen::Vector3d& tip, double dt);

  /// After a step. Motion that is not finite, or without start(), and forces that are not finite are left out.
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
