#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/metrics/motion_measures.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

/// Measures of a force over time.
struct ForceMeasures {
  double time = 0;                    ///< that was recorded [s]
  double loaded_time = 0;             ///< with a force above noise [s]
  double time_above = 0;              ///< with a force above the threshold [s]
  double max = 0;                     ///< [N]
  double impulse = 0;                 ///< integral of the magnitude over time [N s]
  std::optional<double> mean;         ///< over loaded_time; no value without load [N]
  std::optional<double> share_above;  ///< time_above / time; no value without time
};

struct ForceSettings {
  /// Forces above it count in time_above [N]. Default: Trejos et al. 2011, Surg Endosc 25:186: instruments in
  /// transgastric procedures in pigs pushed with more than 5 N in 1.6 % of the samples, with almost 8 N at most.
  double threshold = 5;
  double noise = 1e-6;  ///< smaller forces count as none [N]; design choice
};

/// Accumulates the measures of a force. Call add() once per step; it costs a few additions and does not allocate. With
/// the mean over the step as input all measures are exact except the maximum, which a mean lowers.
class ForceRecorder {
 public:
  /// @throws Error if a setting is negative or not finite
  explicit ForceRecorder(const ForceSettings& settings = {});

  /// @param force  mean over the step, in any frame [N]
  /// @param dt     length of the step [s]
  /// @throws Error, and changes nothing, if the force or the time is not finite or the time is not positive
  void add(const Eigen::Vector3d& force, double dt) { add(force.norm(), dt); }

  /// The same for a magnitude, such as the tension of a thread [N].
  void add(double magnitude, double dt);

  ForceMeasures measures() const;  ///< of all that was added so far

 private:
  ForceSettings settings_;
  ForceMeasures sums_;
  double loaded_impulse_ = 0;  // [N s]
};

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

  const PhasesSkill& measures() const { return measures_; }  ///< as of the last record()

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
