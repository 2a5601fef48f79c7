#include "procedure_message.hpp"

#include "conversions.hpp"

namespace vibe {

vibe_msgs::ProcedureState makeProcedureState(const Session& session, const RunStatus& status) {
  const SessionMetrics& metrics = session.recorder.metrics();
  vibe_msgs::ProcedureState message;
  message.header.stamp = toRosTime(session.now());
  message.scene = session.model->scene.name;
  message.seed = session.state.seed;
  message.step = static_cast<std::uint64_t>(session.state.step);
  message.step_period = session.time.period();
  message.origin = toRosTime(session.time.origin());
  message.paused = status.paused;
  message.phase = phaseOf(session.state, session.input);
  message.held_particles = static_cast<std::uint32_t>(session.state.grip.size());
  message.volume = session.state.volume;
  message.pressure = session.state.pressure;
  message.time = metrics.time;
  message.contact_time = metrics.contact_time;
  message.grip_time = metrics.grip_time;
  message.insufflation_time = metrics.insufflation_time;
  message.path_length = metrics.path_length;
  message.peak_force = metrics.peak_force;
  message.mean_force = metrics.mean_force;
  message.greatest_volume = metrics.greatest_volume;
  message.greatest_pressure = metrics.greatest_pressure;
  message.greatest_strain = metrics.greatest_strain;
  message.energy_balance = metrics.energy_balance;
  message.grabs = static_cast<std::uint32_t>(metrics.grabs);
  message.missed_grabs = static_cast<std::uint32_t>(metrics.missed_grabs);
  message.releases = static_cast<std::uint32_t>(metrics.releases);
  message.slips = static_cast<std::uint32_t>(metrics.slips);
  message.warnings = static_cast<std::uint32_t>(metrics.warnings);
  return message;
}

std::string kindOf(const Session& session, const RunStatus& status) {
  const SessionMetrics& metrics = session.recorder.metrics();
  std::string kind = session.model->scene.name + '|' + phaseOf(session.state, session.input);
  for (int count : {metrics.grabs, metrics.missed_grabs, metrics.releases, metrics.slips, metrics.warnings,
                    static_cast<int>(session.state.grip.size()), status.paused ? 1 : 0}) {
    kind += '|' + std::to_string(count);
  }
  return kind;
}

}  // namespace vibe
