#include "vibe_core/metrics/session_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/skill_text.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/model/accounting.hpp"

namespace vibe {

namespace {
constexpr double kSamplePeriod = 0.1;  // of the costly metrics [s]
constexpr double kNoForce = 1e-6;      // smaller forces count as none [N]
constexpr double kDoubtful = 0.01;     // of the work put in: energy of no account that a reader should know of
constexpr double kLeastWork = 1e-3;    // a session with less counts as one with this much [J]
}  // namespace

MetricsRecorder::MetricsRecorder(const Model& model, const State& start)
    : MetricsRecorder(model, start, SkillInstruments(model)) {}

MetricsRecorder::MetricsRecorder(const Model& model, const State& start, SkillInstruments instruments)
    : instruments_(std::move(instruments)),
      last_tip_(tipPosition(model, start)),
      start_balance_(energyBalance(model, start)),
      strain_(start.x.size()),
      skill_(instruments_, model, start, last_tip_) {
  metrics_.time = start.time;
  metrics_.balance_closes = !model.solver->usesSubsteps();
  metrics_.skill = skill_.metrics();
}

void MetricsRecorder::restart(const Model& model, const State& start) {
  *this = MetricsRecorder(model, start, instruments_);
}

Eigen::Vector3d MetricsRecorder::tipPosition(const Model& model, const State& state) {
  if (!model.tool) return Eigen::Vector3d::Zero();
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses_);
  return model.tool_base * poses_[model.tip_link].translation();
}

void MetricsRecorder::record(const Model& model, const State& state, bool insufflator_on,
                             const std::vector<Event>& events) {
  const double dt = model.scene.step_period;
  metrics_.time = state.time;
  if (state.contact_count > 0) metrics_.contact_time += dt;
  if (!state.grip.empty()) metrics_.grip_time += dt;
  if (insufflator_on) metrics_.insufflation_time += dt;
  const Eigen::Vector3d tip = tipPosition(model, state);
  metrics_.path_length += (tip - last_tip_).norm();
  last_tip_ = tip;
  const double force = state.tool_force.norm();
  if (force > kNoForce) {
    force_sum_ += force * dt;
    force_time_ += dt;
    metrics_.mean_force = force_sum_ / force_time_;
    metrics_.max_force = std::max(metrics_.max_force, force);
  }
  metrics_.volume = state.volume;
  metrics_.pressure = state.pressure;
  metrics_.max_volume = std::max(metrics_.max_volume, state.volume);
  metrics_.max_pressure = std::max(metrics_.max_pressure, state.pressure);
  metrics_.events.record(events);
  skill_.record(model, state, tip, events, metrics_.events);
  metrics_.skill = skill_.metrics();
  if (samples_until_-- <= 0) sample(model, state);
}

void MetricsRecorder::sample(const Model& model, const State& state) {
  samples_until_ = static_cast<int>(std::lround(kSamplePeriod / model.scene.step_period)) - 1;
  model.tissue->strain(state, strain_.data());
  for (float strain : strain_) metrics_.max_strain = std::max(metrics_.max_strain, static_cast<double>(strain));
  metrics_.energy = state.energy;
  metrics_.relaxation_loss = state.relaxation.loss;
  metrics_.energy_balance = energyBalance(model, state) - start_balance_;
}

int SessionMetrics::warnings() const {
  return events.of(Event::Kind::Warning) + events.of(Event::Kind::Recovery);
}

namespace {

// What was put in, what was lost, and what is left over.
std::string summariseEnergy(const EnergyAccount& e, double balance) {
  const auto shown = [](double energy) { return rounded(energy, 4); };
  return formatted(
      "work               tool %.4f J   gas %.4f J   threads %.4f J   pull spring %.4f J\n"
      "losses             sliding tool %.4f J   mass damping %.4f J   stiffness damping %.4f J\n"
      "                   walls in contact %.4f J   time scheme %.4f J\n"
      "solver             corrections %.4f J   residuals %.4f J   energy balance %.4f J\n",
      shown(e.tool_work), shown(e.gas_work), shown(e.thread_work), shown(e.pull_work), shown(e.friction_loss),
      shown(e.damping_loss), shown(e.viscous_loss), shown(e.contact_loss), shown(e.numerical_loss),
      shown(e.correction_work), shown(e.residual_work), shown(balance));
}

std::string summariseRelaxation(double loss) {
  const std::string text = formatted("                   relaxation of the wall %.4f J\n", rounded(loss, 4));
  return loss != 0 ? text : "";
}

// What of these energies a reader should not take for mechanics, a line each with a newline at its end.
std::string doubtsOf(const SessionMetrics& m) {
  const EnergyAccount& e = m.energy;
  const double works = std::abs(e.tool_work) + std::abs(e.gas_work) + std::abs(e.thread_work) + std::abs(e.pull_work);
  const double work = std::max(works, kLeastWork);
  std::string lines;
  if (std::abs(e.correction_work) > kDoubtful * work) {
    lines += formatted(
        "                   The corrections are %.3g %% of the work put in: walls or tool were stopped after a step, "
        "or the wall was led back to rest;\n"
        "                   forces of that time are doubtful; possibly the scope moves too fast.\n",
        100 * std::abs(e.correction_work) / work);
  }
  if (m.balance_closes && std::abs(m.energy_balance) > kDoubtful * work) {
    lines += formatted(
        "                   The energy balance is off by %.3g %% of the work put in: forces and energies of this "
        "session are doubtful.\n",
        100 * std::abs(m.energy_balance) / work);
  }
  return lines;
}

// What was seen, a line with a newline at its end; empty where nobody looked.
std::string summariseCoverage(const CoverageSkill& coverage) {
  if (!coverage.whole) return {};
  const auto percent = [](double share) { return rounded(100 * share, 1); };
  std::string line = formatted("wall seen          %8.1f %%    ", percent(*coverage.whole));
  for (int k = 0; k < kRegionCount; ++k) {
    const std::optional<double>& share = coverage.region[static_cast<std::size_t>(k)];
    if (!share) continue;
    line += formatted("%s %.1f %%   ", toString(static_cast<Region>(k)), percent(*share));
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string summarise(const SessionMetrics& m) {
  using Kind = Event::Kind;
  return formatted(
             "simulated time     %8.2f s\n"
             "in contact         %8.2f s   holding tissue %.2f s   insufflating %.2f s\n"
             "path of the tip    %8.3f m\n"
             "grabs              %8d     missed %d   released %d   slipped %d\n"
             "force on the tool  %8.2f N max   %.2f N mean\n"
             "lumen              %8.1f mL now   %.1f mL max   at %.1f mmHg now   %.1f mmHg max\n"
             "strain of the wall %8.1f %% max\n"
             "%s%s"
             "warnings           %8d",
             m.time, m.contact_time, m.grip_time, m.insufflation_time, m.path_length, m.events.of(Kind::Grab),
             m.events.of(Kind::GrabMissed), m.events.of(Kind::Release), m.events.of(Kind::Slip), m.max_force,
             m.mean_force, m.volume * 1e6, m.max_volume * 1e6, m.pressure / 133.322, m.max_pressure / 133.322,
             100 * m.max_strain, summariseCoverage(m.coverage).c_str(),
             (summariseEnergy(m.energy, m.energy_balance) + summariseRelaxation(m.relaxation_loss) + doubtsOf(m))
                 .c_str(),
             m.warnings()) +
         "\n" + summarise(m.skill);
}

}  // namespace vibe
