#include "vibe_core/metrics/session_report.hpp"

#include <algorithm>
#include <cinttypes>
#include <iostream>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

void writeProcedure(const ProcedureState& procedure, std::ostream& out) {
  std::size_t bites = 0;
  double tension = 0;
  for (const Suture& suture : procedure.sutures) {
    bites += suture.bites.size();
    for (double t : suture.tension) tension = std::max(tension, t);
  }
  out << ',' << toString(procedure.phase) << ',' << bites << ',' << procedure.sutures.size() << ',' << tension << ','
      << procedure.blood_lost << ',';
}

}  // namespace

SessionCsv::SessionCsv(const std::string& file) : out_(&file_) {
  if (file == "-") {
    out_ = &std::cout;
  } else {
    whole_ = std::make_unique<WholeFile>(file, "The CSV");
    file_.open(whole_->part(), std::ios::trunc);
  }
  out_->precision(9);
  *out_ << "step,time";
  for (const char* name : kJointNames) *out_ << ',' << name;
  *out_ << ",tip_x,tip_y,tip_z,force_x,force_y,force_z,torque_x,torque_y,torque_z,grip_force,contact_count,grip_count,"
           "pressure,volume,phase,bites,sutures,thread_tension,blood_lost,events\n";
  if (!*out_) throw Error("Cannot write '" + file + "'; check that its folder exists and has room.");
}

void SessionCsv::write(const Model& model, const State& state, const std::vector<Event>& events) {
  std::ostream& out = *out_;
  out << state.step << ',' << state.time;
  for (double joint : state.joints) out << ',' << joint;
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  if (model.tool) {
    model.tool->forwardKinematics(state.joints, state.tool_displacement, poses_);
    tip = model.tool_base * poses_[model.tip_link].translation();
  }
  for (const Eigen::Vector3d& v : {tip, state.tool_force, state.tool_torque})
    out << ',' << v.x() << ',' << v.y() << ',' << v.z();
  out << ',' << state.grip_force << ',' << state.contact_count << ',' << state.grip.size() << ',' << state.pressure
      << ',' << state.volume;
  writeProcedure(state.procedure, out);
  for (std::size_t i = 0; i < events.size(); ++i) out << (i > 0 ? ";" : "") << toString(events[i].kind);
  out << '\n';
  check();
}

void SessionCsv::finish() {
  out_->flush();
  check();
  if (whole_) file_.close(), whole_->finish(file_.good());
}

void SessionCsv::check() const {
  if (!*out_) throw Error("The CSV could not be written to its end; check the room on the disk.");
}

std::string toHex(std::uint64_t value) {
  return formatted("%016" PRIx64, value);
}

std::string runSummary(const SessionMetrics& metrics, const DurationHistogram& solver_cpu, int particle_count,
                       double simulated, double wall, std::uint64_t state_hash) {
  return summarise(metrics) + "\n" +
         formatted("solver per step    %8.2f ms p50   %.2f ms p99   %.2f ms max of CPU time, %" PRIu64
                   " steps of %d particles\n"
                   "real-time factor   %8.2f\n",
                   1e3 * solver_cpu.quantile(0.5), 1e3 * solver_cpu.quantile(0.99), 1e3 * solver_cpu.max(),
                   solver_cpu.count(), particle_count, wall > 0 ? simulated / wall : 0.0) +
         "state hash: " + toHex(state_hash) + "\n";
}

}  // namespace vibe
