#pragma once
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/metrics/coverage_skill.hpp"
#include "vibe_core/metrics/skill_metrics.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Measures of a session so far. MetricsRecorder updates them once per step.
struct SessionMetrics {
  double time = 0;               ///< simulated since the start [s]
  double contact_time = 0;       ///< the tool touched tissue [s]
  double grip_time = 0;          ///< the helix held tissue [s]
  double insufflation_time = 0;  ///< the insufflator was on [s]
  double path_length = 0;        ///< of scope_tip [m]
  double max_force = 0;          ///< of the tissue on the tool [N]
  double mean_force = 0;         ///< of that force while there is any [N]
  double volume = 0;             ///< of the lumen, now [m^3]
  double max_volume = 0;         ///< [m^3]
  double pressure = 0;           ///< gauge, now [Pa]
  double max_pressure = 0;       ///< [Pa]
  double max_strain = 0;         ///< in-plane, over particles and time, sampled ten times a second
  EnergyAccount energy;          ///< of the last state
  double relaxation_loss = 0;    ///< of the last state, see RelaxationMemory; 0 where the wall is elastic [J]
  double energy_balance = 0;     ///< see energyBalance(), sampled ten times a second; drift since the start [J]
  bool balance_closes = true;    ///< the solver has an account of all that it loses; shape matching has not
  EventCounts events;            ///< since the start, by kind
  SkillMetrics skill;            ///< measures of the procedure
  CoverageSkill coverage;        ///< what the lens has seen; empty in scenes without `inspection`

  int warnings() const;  ///< warnings and recoveries
};

/// Accumulates SessionMetrics. Reads the state of the simulation and does not change it.
class MetricsRecorder {
 public:
  /// @param model  its organ must outlive this
  MetricsRecorder(const Model& model, const State& start);

  /// Starts again with another state of the same model, without the expensive part of the construction.
  void restart(const Model& model, const State& start);

  /// Call after every step() with its events.
  void record(const Model& model, const State& state, bool insufflator_on, const std::vector<Event>& events);

  /// What has been seen, by who looks; restart() forgets it.
  void setCoverage(const CoverageSkill& coverage) { metrics_.coverage = coverage; }

  /// Warnings of the program about its inputs, which no step has seen.
  void addWarnings(int count) { metrics_.events.record(std::vector<Event>(static_cast<std::size_t>(count))); }

  /// As of the last record(); before the first, those of the start.
  const SessionMetrics& metrics() const { return metrics_; }

 private:
  MetricsRecorder(const Model& model, const State& start, SkillInstruments instruments);
  void sample(const Model& model, const State& state);
  Eigen::Vector3d tipPosition(const Model& model, const State& state);

  SkillInstruments instruments_;
  std::vector<Eigen::Isometry3d> poses_;
  SessionMetrics metrics_;
  Eigen::Vector3d last_tip_ = Eigen::Vector3d::Zero();
  double force_sum_ = 0;
  double force_time_ = 0;
  double start_balance_ = 0;
  int samples_until_ = 0;
  std::vector<float> strain_;
  SkillRecorder skill_;
};

/// The metrics as lines of text for people, the skill measures last, without a trailing newline.
std::string summarise(const SessionMetrics& metrics);

}  // namespace vibe
