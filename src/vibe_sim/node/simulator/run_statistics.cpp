#include "simulator/run_statistics.hpp"

#include <algorithm>
#include <cstdio>

#include "conversions/conversions.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/scene/mesh_guess.hpp"

namespace vibe::sim {

namespace {

constexpr double kWindow = 1.0;  // [s]

double ratio(double simulated, double wall) {
  return wall > 0 ? simulated / wall : 0;
}

}  // namespace

void RunStatistics::begin(Session& session) {
  begin_ = steadyTime();
  startWindow(session);
}

void RunStatistics::countStep(double period, const StepReport& report) {
  for (Work* work : {&window_work_, &all_work_}) {
    work->residual = std::max(work->residual, report.residual);
    work->unfinished += report.arrived ? 0 : 1;
  }
  ++steps;
  simulated_ += period;
  window_simulated_ += period;
}

bool RunStatistics::windowIsOver() const {
  return steadyTime() - window_begin_ >= kWindow;
}

void RunStatistics::startWindow(Session& session) {
  window_begin_ = steadyTime();
  window_simulated_ = 0;
  all_missed_deadlines_ += missed_deadlines;
  missed_deadlines = 0;
  window_work_ = Work();
  for (StepTimer* timer : {&session.simulation.timer(), &publish, &total}) {
    timer->cpu.window.clear();
    timer->wall.window.clear();
  }
}

vibe_msgs::SolverStatistics RunStatistics::message(const Session& session,
                                                   DurationHistogram DurationRecord::*which) const {
  vibe_msgs::SolverStatistics message;
  message.header.stamp = toRosTime(session.now());
  const StepTimer& solver = session.simulation.timer();
  message.stages = {makeStageTime("solver", solver.cpu.*which), makeStageTime("solver_wall", solver.wall.*which),
                    makeStageTime("publish", publish.wall.*which), makeStageTime("total", total.wall.*which)};
  message.steps = static_cast<std::uint64_t>(steps);
  message.state_hash = toHex(session.simulation.hash());
  const std::vector<double>& inverse_mass = session.model->inverse_mass;
  message.particle_count = static_cast<std::uint32_t>(session.model->particle_count);
  message.active_count = static_cast<std::uint32_t>(
      std::count_if(inverse_mass.begin(), inverse_mass.end(), [](double w) { return w > 0; }));
  message.contact_count = static_cast<std::uint32_t>(session.state.contact_count);
  return message;
}

vibe_msgs::SolverStatistics RunStatistics::windowMessage(const Session& session) const {
  vibe_msgs::SolverStatistics result = message(session, &DurationRecord::window);
  result.window = steadyTime() - window_begin_;
  result.real_time_factor = ratio(window_simulated_, result.window);
  result.missed_deadlines = missed_deadlines;
  result.residual = window_work_.residual;
  result.unfinished_steps = window_work_.unfinished;
  return result;
}

vibe_msgs::SolverStatistics RunStatistics::wholeMessage(const Session& session) const {
  vibe_msgs::SolverStatistics result = message(session, &DurationRecord::all);
  result.window = steadyTime() - begin_;
  result.real_time_factor = ratio(simulated_, result.window);
  result.missed_deadlines = all_missed_deadlines_ + missed_deadlines;
  result.residual = all_work_.residual;
  result.unfinished_steps = all_work_.unfinished;
  return result;
}

std::string RunStatistics::progressLine(const Session& session) const {
  const DurationHistogram& times = session.simulation.timer().cpu.window;
  char line[160];
  std::snprintf(line, sizeof line, "t = %7.2f s  %-12s  %5.2f x real time  solver p50 %5.2f ms  p99 %5.2f ms",
                session.state.time, toolStateOf(session.state, session.input),
                ratio(window_simulated_, steadyTime() - window_begin_), 1e3 * times.quantile(0.5),
                1e3 * times.quantile(0.99));
  return line;
}

std::string RunStatistics::summary(const Session& session) const {
  return landmarkRemark(session.model->scene) + runSummary(session.metrics(), session.simulation.timer().cpu.all,
                                                           session.model->particle_count, simulated_,
                                                           steadyTime() - begin_, session.simulation.hash());
}

}  // namespace vibe::sim
