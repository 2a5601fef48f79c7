#include "contact/hard_case.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "contact/contact_run.hpp"
#include "contact/way_counts.hpp"
#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/model/accounting.hpp"

namespace vibe::benchmarks {
namespace {

/// The fields of the account, in order.
template <class Visit>
void forEachTerm(Visit visit) {
  visit("tool_work", &EnergyAccount::tool_work);
  visit("gas_work", &EnergyAccount::gas_work);
  visit("thread_work", &EnergyAccount::thread_work);
  visit("pull_work", &EnergyAccount::pull_work);
  visit("damping_loss", &EnergyAccount::damping_loss);
  visit("viscous_loss", &EnergyAccount::viscous_loss);
  visit("contact_loss", &EnergyAccount::contact_loss);
  visit("numerical_loss", &EnergyAccount::numerical_loss);
  visit("correction_work", &EnergyAccount::correction_work);
}

double farthest(const State& a, const State& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    most = std::max(most, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i], a.z[i] - b.z[i]));
  return most;
}

class Runner {
 public:
  Runner(const HardCase& hard, const HardOutput& output) : hard_(hard), output_(output), model_(hard.model) {
    result_.name = hard.name;
    result_.returns = hard.returns;
    take(hard.model, hard.start);
    balance_start_ = energyBalance(*model_, hard.start);
  }

  HardResult run() {
    for (const HardPhase& phase : hard_.phases) {
      if (phase.model) take(phase.model, State(simulation_->state()));
      if (phase.prepare) phase.prepare(*simulation_);
      const int steps = static_cast<int>(std::lround(phase.duration / simulation_->stepPeriod()));
      for (int k = 1; k <= steps; ++k) step(phase, k * simulation_->stepPeriod());
    }
    finish();
    return result_;
  }

 private:
  void take(std::shared_ptr<const Model> model, State state) {
    model_ = std::move(model);
    SimulationSettings settings = SimulationSettings::study(1);
    settings.stages = output_.steps != nullptr;
    simulation_ = std::make_unique<Simulation>(model_, settings);
    simulation_->replaceState(std::move(state));
    check_ = std::make_unique<ContactCheck>(*model_);
    first_ = true;
  }

  void step(const HardPhase& phase, double end) {
    const EnergyAccount account = simulation_->state().energy;
    const auto& events = simulation_->step(phase.input(end));
    const double ms = 1e3 * simulation_->timer().last_cpu;
    if (!first_) cpu_.push_back(ms);
    first_ = false;
    ++result_.steps;
    result_.work += workBetween(account, simulation_->state().energy);
    countEvents(events);
    lookAtSolver();
    lookAtCrossings();
    const double balance = energyBalance(*model_, simulation_->state()) - balance_start_;
    if (std::abs(balance) > std::abs(result_.worst_balance)) result_.worst_balance = balance;
    if (output_.steps != nullptr) writeStep(phase, ms, balance);
  }

  void countEvents(const std::vector<Event>& events) {
    for (const Event& event : events) {
      result_.slips += event.kind == Event::Kind::Slip;
      result_.tear_outs += event.kind == Event::Kind::TearOut;
      result_.breaks += event.kind == Event::Kind::ThreadBroke;
      result_.recoveries += event.kind == Event::Kind::Recovery;
    }
  }

  void lookAtSolver() {
    const State& state = simulation_->state();
    const StepReport& report = simulation_->report();
    if (output_.ways != nullptr) output_.ways->add(report);
    result_.iterations += report.iterations;
    result_.max_iterations = std::max(result_.max_iterations, report.iterations);
    result_.fallback_steps += report.fallback ? 1 : 0;
    result_.contacts = std::max(result_.contacts, state.contact_count);
    result_.force = std::max(result_.force, state.tool_force.norm());
    result_.grip_force = std::max(result_.grip_force, state.grip_force);
    for (const Suture& suture : state.procedure.sutures)
      for (const double tension : suture.tension) result_.tension = std::max(result_.tension, tension);
  }

  void lookAtCrossings() {
    const State& state = simulation_->state();
    const int pairs = static_cast<int>(check_->wall(state).size());
    tool_ = check_->tool(state);
    result_.last_crossings = pairs;
    result_.crossings = std::max(result_.crossings, pairs);
    result_.crossed_steps += pairs > 0 ? 1 : 0;
    result_.pierced = std::max(result_.pierced, tool_.pierced);
    result_.depth = std::max(result_.depth, tool_.depth);
    if (result_.first_crossing >= 0 || (pairs == 0 && tool_.pierced == 0)) return;
    result_.first_crossing = result_.steps * simulation_->stepPeriod();
  }

  void writeStep(const HardPhase& phase, double ms, double balance) const {
    const State& state = simulation_->state();
    *output_.steps << formatted("%s,%s,%.4f,%.3f,%d,%d,%d,%d,%d,%.4g,%.4g,%.4g,%.5g,%.5g", hard_.name.c_str(),
                                phase.name.c_str(), result_.steps * simulation_->stepPeriod(), ms,
                                simulation_->report().iterations, simulation_->report().fallback ? 1 : 0,
                                state.contact_count, result_.last_crossings, tool_.pierced, 1e3 * tool_.depth,
                                state.tool_force.norm(), state.grip_force, balance, maxSpeed(state));
    writeWork();
  }

  void writeWork() const {
    const StepReport& report = simulation_->report();
    *output_.steps << formatted(",%d,%d,%d,%d,%d,%.4g", report.solves, report.evaluations, report.rows,
                                report.wall_pairs, report.arrived ? 1 : 0, report.residual);
    for (const double seconds : report.stage_times) *output_.steps << formatted(",%.3f", 1e3 * seconds);
    *output_.steps << "\n";
  }

  void finish() {
    const State& state = simulation_->state();
    result_.times = timesOf(cpu_);
    result_.iterations /= std::max(1, result_.steps);
    double spent = 0;
    for (const double ms : cpu_) spent += 1e-3 * ms;
    result_.real_time = spent > 0 ? static_cast<double>(cpu_.size()) * simulation_->stepPeriod() / spent : 0;
    result_.balance = energyBalance(*model_, state) - balance_start_;
    forEachTerm([&](const char*, double EnergyAccount::*term) {
      result_.account.*term = state.energy.*term - hard_.start.energy.*term;
    });
    result_.speed = maxSpeed(state);
    result_.away = farthest(state, hard_.home);
    result_.hash = simulation_->hash();
  }

  const HardCase& hard_;
  const HardOutput& output_;
  std::shared_ptr<const Model> model_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<ContactCheck> check_;
  test::ToolCrossing tool_;
  HardResult result_;
  std::vector<double> cpu_;
  double balance_start_ = 0;
  bool first_ = true;
};

}  // namespace

HardPhase phaseOf(const std::string& name, double duration, std::function<StepInput(double)> input) {
  return {name, duration, std::move(input), nullptr, {}};
}

HardPhase still(const std::string& name, double duration, const StepInput& input) {
  return phaseOf(name, duration, [input](double) { return input; });
}

HardResult runHardCase(const HardCase& hard, const HardOutput& output) {
  return Runner(hard, output).run();
}

void writeHardResults(const std::vector<HardResult>& results, std::ostream& out) {
  out << "case,steps,ms_mean,ms_p50,ms_p99,ms_max,real_time,iterations_mean,iterations_max,fallback_steps,crossings,"
         "crossed_steps,last_crossings,first_crossing_s,pierced,depth_mm,contacts,tool_N,grip_N,thread_N,slips,"
         "tear_outs,breaks,recoveries,work_J,balance_J,worst_balance_J";
  forEachTerm([&](const char* name, double EnergyAccount::*) { out << "," << name << "_J"; });
  out << ",speed_mm_s,away_mm,returns,state_hash\n";
  for (const HardResult& r : results) {
    out << formatted(
        "%s,%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.3g,%d,%d,%d,%d,%d,%.4g,%d,%.4g,%d,%.4g,%.4g,%.4g,%d,%d,%d,%d,%.6g,"
        "%.6g,%.6g",
        r.name.c_str(), r.steps, r.times.mean, r.times.p50, r.times.p99, r.times.max, r.real_time, r.iterations,
        r.max_iterations, r.fallback_steps, r.crossings, r.crossed_steps, r.last_crossings, r.first_crossing, r.pierced,
        1e3 * r.depth, r.contacts, r.force, r.grip_force, r.tension, r.slips, r.tear_outs, r.breaks, r.recoveries,
        r.work, r.balance, r.worst_balance);
    forEachTerm([&](const char*, double EnergyAccount::*term) { out << formatted(",%.6g", r.account.*term); });
    out << formatted(",%.4g,%.4g,%d,%016llx\n", 1e3 * r.speed, 1e3 * r.away, r.returns ? 1 : 0,
                     static_cast<unsigned long long>(r.hash));
  }
}

void writeHardStepHeader(std::ostream& out) {
  out << "case,phase,time_s,ms,iterations,fallback,contacts,crossings,pierced,depth_mm,tool_N,grip_N,balance_J,"
         "speed_m_s,solves,evaluations,rows,wall_pairs,arrived,residual_m";
  for (int k = 0; k < kStepStages; ++k) out << "," << toString(static_cast<StepStage>(k)) << "_ms";
  out << "\n";
}

}  // namespace vibe::benchmarks
