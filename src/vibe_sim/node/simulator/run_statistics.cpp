#include "simulator/run_statistics.hpp"

#include <algorithm>

#include "conversions/conversions.hpp"
#include "conversions/procedure_message.hpp"
#include "conversions/session_message.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace vibe::sim {

namespace {

constexpr double kWindow = 1.0;  // [s]

double ratio(double simulated, double wall) {
  return wall > 0 ? simulated / wall : 0;
}

}  // namespace

const char* lagRemedy(double usual, double longest, double period) {
  if (usual >= period) return "use fewer particles or substeps";
  if (longest >= period) return "single steps are long; if that comes often, use fewer particles or substeps";
  return "no step was too long, so the machine may be busy with something else; stop other programs";
}

void RunStatistics::begin(TimedSimulation& simulation) {
  begin_ = steadyTime();
  startWindow(simulation);
}

void RunStatistics::countStep(double period, const StepReport& report) {
  for (Work* work : {&window_work_, &all_work_}) {
    work->residual = std::max(work->residual, report.residual);
    work->unfinished += report.arrived ? 0 : 1;
  }
  for (std::size_t k = 0; k < stages_.size(); ++k) stages_[k].add(report.stage_times[k]);
  ++steps;
  simulated_ += period;
  window_simulated_ += period;
}

bool RunStatistics::windowIsOver() const {
  return steadyTime() - window_begin_ >= kWindow;
}

void RunStatistics::startWindow(TimedSimulation& simulation) {
  window_begin_ = steadyTime();
  window_simulated_ = 0;
  all_missed_deadlines_ += missed_deadlines;
  missed_deadlines = 0;
  window_work_ = Work();
  for (DurationRecord& stage : stages_) stage.window.clear();
  for (StepTimer* timer : {&simulation.timer(), &publish, &total}) {
    timer->cpu.window.clear();
    timer->wall.window.clear();
  }
}

vibe_msgs::SolverStatistics RunStatistics::message(const TimedSimulation& simulation,
                                                   DurationHistogram DurationRecord::*which) const {
  auto message = stamped<vibe_msgs::SolverStatistics>(simulation.now());
  const StepTimer& solver = simulation.timer();
  message.stages = {makeStageTime("solver", solver.cpu.*which), makeStageTime("solver_wall", solver.wall.*which),
                    makeStageTime("publish", publish.wall.*which), makeStageTime("total", total.wall.*which)};
  for (std::size_t k = 0; k < stages_.size(); ++k)
    message.stages.push_back(
        makeStageTime("solver_" + std::string(toString(static_cast<StepStage>(k))), stages_[k].*which));
  message.steps = static_cast<std::uint64_t>(steps);
  message.state_hash = toHex(simulation.simulation().hash());
  const std::vector<double>& inverse_mass = simulation.model().inverse_mass;
  message.particle_count = static_cast<std::uint32_t>(simulation.model().particle_count);
  message.active_count = static_cast<std::uint32_t>(
      std::count_if(inverse_mass.begin(), inverse_mass.end(), [](double w) { return w > 0; }));
  message.session = simulation.session();
  message.contact_count = static_cast<std::uint32_t>(simulation.state().contact_count);
  return message;
}

vibe_msgs::SolverStatistics RunStatistics::windowMessage(const TimedSimulation& simulation) const {
  vibe_msgs::SolverStatistics result = message(simulation, &DurationRecord::window);
  result.window = steadyTime() - window_begin_;
  result.real_time_factor = ratio(window_simulated_, result.window);
  result.missed_deadlines = missed_deadlines;
  result.residual = window_work_.residual;
  result.unfinished_steps = window_work_.unfinished;
  return result;
}

vibe_msgs::SolverStatistics RunStatistics::wholeMessage(const TimedSimulation& simulation) const {
  vibe_msgs::SolverStatistics result = message(simulation, &DurationRecord::all);
  result.window = steadyTime() - begin_;
  result.real_time_factor = ratio(simulated_, result.window);
  result.missed_deadlines = all_missed_deadlines_ + missed_deadlines;
  result.residual = all_work_.residual;
  result.unfinished_steps = all_work_.unfinished;
  return result;
}

std::string RunStatistics::progressLine(const TimedSimulation& simulation) const {
  const DurationHistogram& times = simulation.timer().cpu.window;
  return formatted("t = %7.2f s  %-12s  %5.2f x real time  solver p50 %5.2f ms  p99 %5.2f ms", simulation.state().time,
                   toolStateOf(simulation.state(), simulation.input()),
                   ratio(window_simulated_, steadyTime() - window_begin_), 1e3 * times.quantile(0.5),
                   1e3 * times.quantile(0.99));
}

std::string RunStatistics::summary(const TimedSimulation& simulation) const {
  return landmarkRemark(simulation.model().scene) + runSummary(simulation.metrics(), simulation.timer().cpu.all,
                                                               simulation.model().particle_count, simulated_,
                                                               steadyTime() - begin_, simulation.simulation().hash());
}

}  // namespace vibe::sim
