#pragma once
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/metrics/skill_metrics.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// What a session was like so far. Updated once per step by MetricsRecorder.
struct SessionMetrics {
  double time = 0;               ///< simulated since the start [s]
  double contact_time = 0;       ///< the tool touched tissue [s]
  double grip_time = 0;          ///< the helix held tissue [s]
  double insufflation_time = 0;  ///< the insufflator was on [s]
  double path_length = 0;        ///< of scope_tip [m]
  double peak_force = 0;         ///< greatest tissue reaction on the tool [N]
  double mean_force = 0;         ///< of the reaction while there is any [N]
  double volume = 0;             ///< of the lumen, now [m^3]
  double max_volume = 0;         ///< [m^3]
  double pressure = 0;           ///< gauge, now [Pa]
  double max_pressure = 0;       ///< [Pa]
  double max_strain = 0;         ///< in-plane, over particles and time, sampled ten times a second [1]
  double energy_balance = 0;     ///< see energyBalance(), sampled ten times a second; drift since the start [J]
  int grabs = 0;
  int missed_grabs = 0;
  int releases = 0;
  int slips = 0;
  int warnings = 0;  ///< warnings and recoveries
  SkillMetrics skill;
};

/// Accumulates SessionMetrics; the only state is what it sums. Reads the state and changes nothing of it.
class MetricsRecorder {
 public:
  /// @param model  its organ must outlive this
  MetricsRecorder(const Model& model, const State& start);

  /// Begins afresh with another state of the same model, without the costly part of making one.
  void restart(const Model& model, const State& start);

  /// Call after every step() with its events.
  void record(const Model& model, const State& state, bool insufflator_on, const std::vector<Event>& events);

  const SessionMetrics& metrics() const { return metrics_; }

 private:
  MetricsRecorder(const Model& model, const State& start, SkillInstruments instruments);
  void countEvents(const std::vector<Event>& events);
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

/// The metrics, skill after all else, as lines of text for people, without a trailing newline.
std::string summarise(const SessionMetrics& metrics);

}  // namespace vibe
