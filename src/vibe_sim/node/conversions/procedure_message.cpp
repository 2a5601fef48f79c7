#include "conversions/procedure_message.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "conversions/conversions.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"

namespace vibe::sim {

namespace {

// The numbers on the wire are those of the library.
using Wire = vibe_msgs::ProcedureEvent;
static_assert(
    same(Event::Kind::Grab, Wire::GRAB) && same(Event::Kind::GrabMissed, Wire::GRAB_MISSED) &&
    same(Event::Kind::Release, Wire::RELEASE) && same(Event::Kind::Slip, Wire::SLIP) &&
    same(Event::Kind::ContactBegin, Wire::CONTACT_BEGIN) && same(Event::Kind::ContactEnd, Wire::CONTACT_END) &&
    same(Event::Kind::PressureReached, Wire::PRESSURE_REACHED) && same(Event::Kind::Warning, Wire::WARNING) &&
    same(Event::Kind::Recovery, Wire::RECOVERY) && same(Event::Kind::Rejected, Wire::REJECTED) &&
    same(Event::Kind::Mark, Wire::MARK) && same(Event::Kind::Burn, Wire::BURN) &&
    same(Event::Kind::DeepBurn, Wire::DEEP_BURN) && same(Event::Kind::HelixTurned, Wire::HELIX_TURNED) &&
    same(Event::Kind::Bite, Wire::BITE) && same(Event::Kind::BiteMissed, Wire::BITE_MISSED) &&
    same(Event::Kind::BiteWithdrawn, Wire::BITE_WITHDRAWN) &&
    same(Event::Kind::NeedleExchanged, Wire::NEEDLE_EXCHANGED) &&
    same(Event::Kind::BleedingMild, Wire::BLEEDING_MILD) && same(Event::Kind::BleedingBrisk, Wire::BLEEDING_BRISK) &&
    same(Event::Kind::BleedingStopped, Wire::BLEEDING_STOPPED) &&
    same(Event::Kind::BleedingOverdue, Wire::BLEEDING_OVERDUE) &&
    same(Event::Kind::TechniqueFound, Wire::TECHNIQUE_FOUND) && same(Event::Kind::TTagDropped, Wire::T_TAG_DROPPED) &&
    same(Event::Kind::CinchPulling, Wire::CINCH_PULLING) && same(Event::Kind::Cinched, Wire::CINCHED) &&
    same(Event::Kind::CinchLoose, Wire::CINCH_LOOSE) && same(Event::Kind::TearOut, Wire::TEAR_OUT) &&
    same(Event::Kind::ThreadBroke, Wire::THREAD_BROKE) && same(Event::Kind::PhaseChanged, Wire::PHASE_CHANGED) &&
    same(Event::Kind::Pierced, Wire::PIERCED) && same(Event::Kind::ArmClosed, Wire::ARM_CLOSED) &&
    same(Event::Kind::Blocked, Wire::BLOCKED) && same(Event::Kind::LeftLumen, Wire::LEFT_LUMEN));

/// Particles whose grade is this or worse.
std::uint32_t countGrades(const std::vector<std::uint8_t>& grades, BurnGrade min) {
  const auto reached = [min](std::uint8_t grade) { return grade >= static_cast<std::uint8_t>(min); };
  return static_cast<std::uint32_t>(std::count_if(grades.begin(), grades.end(), reached));
}

void countSuture(const Suture& suture, const Scene& scene, vibe_msgs::ProcedureState& message) {
  const auto tear_outs = static_cast<std::uint32_t>(suture.tear_outs);
  message.bites += static_cast<std::uint32_t>(suture.bites.size()) + tear_outs;
  message.tear_outs += tear_outs;
  for (const Bite& bite : suture.bites) message.partial_bites += bite.fullThickness() ? 0 : 1;
  const bool cinched = suture.stage == Suture::Stage::Cinched;
  const bool loose = cinched && scene.suture && suture.cinch_tension < scene.suture->loose_tension;
  message.sutures_open += suture.permanent() ? 0 : 1;
  message.sutures_cinched += cinched && !loose ? 1 : 0;
  message.sutures_loose += loose ? 1 : 0;
  message.sutures_broken += suture.stage == Suture::Stage::Broken ? 1 : 0;
  if (suture.stage >= Suture::Stage::Tagged) {
    message.techniques.emplace_back(toString(static_cast<Technique>(suture.technique)));
    message.technique_margins.push_back(suture.technique_margin);
  }
}

void addProcedure(const ProcedureState& procedure, const Scene& scene, vibe_msgs::ProcedureState& message) {
  message.phase = toString(procedure.phase);
  message.marks = countGrades(procedure.grade, BurnGrade::Mark);
  message.burns = countGrades(procedure.grade, BurnGrade::Burn);
  message.deep_burns = countGrades(procedure.grade, BurnGrade::Deep);
  message.beam_energy = procedure.beam_energy;
  message.sutures = static_cast<std::uint32_t>(procedure.sutures.size());
  for (const Suture& suture : procedure.sutures) countSuture(suture, scene, message);
  message.blood_lost = procedure.blood_lost;
  for (const Bleeding& bleeding : procedure.bleedings) message.bleeding += bleeding.rate > 0 ? 1 : 0;
  message.needle_loaded = procedure.needle_loaded;
  message.needle_on_arm = procedure.needle_on_arm;
  message.thread_used = procedure.thread_used;
}

/// Contact begins and ends too often to publish at once.
long countWithoutContact(const EventCounts& counts) {
  return counts.total() - counts.of(Event::Kind::ContactBegin) - counts.of(Event::Kind::ContactEnd);
}

std::uint32_t countOf(Event::Kind kind, const EventCounts& counts) {
  return static_cast<std::uint32_t>(counts.of(kind));
}

void addCounts(const EventCounts& counts, vibe_msgs::SkillMetrics& message) {
  using Kind = Event::Kind;
  message.grabs = countOf(Kind::Grab, counts);
  message.missed_grabs = countOf(Kind::GrabMissed, counts);
  message.releases = countOf(Kind::Release, counts);
  message.slips = countOf(Kind::Slip, counts);
  message.missed_bites = countOf(Kind::BiteMissed, counts);
  message.withdrawn_bites = countOf(Kind::BiteWithdrawn, counts);
  message.broken_threads = countOf(Kind::ThreadBroke, counts);
  message.overdue_bleedings = countOf(Kind::BleedingOverdue, counts);
  message.rejected = countOf(Kind::Rejected, counts);
}

double valueOrNan(std::optional<double> value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

double maxForce(const ForceMeasures& force) {
  return valueOrNan(force.loaded_time > 0 ? std::optional<double>(force.max) : std::nullopt);
}

void addPhases(const PhasesSkill& phases, vibe_msgs::SkillMetrics& message) {
  for (std::size_t k = 0; k < phases.phase.size(); ++k) {
    const PhaseSkill& skill = phases.phase[k];
    message.phase_time[k] = skill.time;
    message.phase_path_length[k] = skill.motion.path_length;
    message.phase_log_dimensionless_jerk[k] = valueOrNan(skill.motion.log_dimensionless_jerk);
    message.phase_spectral_arc_length[k] = valueOrNan(skill.motion.spectral_arc_length);
    message.phase_submovements[k] = static_cast<std::uint32_t>(skill.motion.submovements);
    message.phase_economy[k] = valueOrNan(skill.motion.economy);
    message.phase_max_force[k] = maxForce(skill.force);
    message.phase_mean_force[k] = valueOrNan(skill.force.mean);
    message.phase_time_above[k] = skill.force.time_above;
  }
  message.log_dimensionless_jerk = valueOrNan(phases.whole.motion.log_dimensionless_jerk);
  message.spectral_arc_length = valueOrNan(phases.whole.motion.spectral_arc_length);
  message.submovements = static_cast<std::uint32_t>(phases.whole.motion.submovements);
  message.economy = valueOrNan(phases.whole.motion.economy);
  message.time_above = phases.whole.force.time_above;
}

void addMarks(const MarkSkill& marks, vibe_msgs::SkillMetrics& message) {
  const auto on = [&marks](Wall wall) {
    return static_cast<std::uint32_t>(marks.wall[static_cast<std::size_t>(wall)]);
  };
  message.mark_zones = static_cast<std::uint32_t>(marks.zones);
  message.mark_zones_inside = static_cast<std::uint32_t>(marks.inside);
  message.mark_zones_anterior = on(Wall::Anterior);
  message.mark_zones_greater_curvature = on(Wall::GreaterCurvature);
  message.mark_zones_posterior = on(Wall::Posterior);
  message.burn_zones = static_cast<std::uint32_t>(marks.burns);
  message.deep_burn_zones = static_cast<std::uint32_t>(marks.deep_burns);
}

void addBites(const BiteSkill& bites, vibe_msgs::SkillMetrics& message) {
  message.bite_spacing_mean = valueOrNan(bites.spacing_mean);
  message.bite_spacing_sd = valueOrNan(bites.spacing_sd);
  message.bite_depth_mean = valueOrNan(bites.depth_mean);
  message.bite_depth_sd = valueOrNan(bites.depth_sd);
  message.full_thickness_share = valueOrNan(bites.full_thickness_share);
  message.bites_in_antrum = static_cast<std::uint32_t>(bites.in_antrum);
  message.bites_in_fundus = static_cast<std::uint32_t>(bites.in_fundus);
  message.bites_proximal = valueOrNan(bites.bites_proximal);
  message.sets_proximal = valueOrNan(bites.sets_proximal);
}

void addOrgan(const OrganSkill& organ, vibe_msgs::SkillMetrics& message) {
  message.organ_reference = toString(organ.reference);
  message.reference_pressure = organ.reference_pressure;
  message.organ_pressure = organ.pressure;
  message.lumen_area = valueOrNan(organ.now ? organ.now->mean_area : std::nullopt);
  message.organ_length = valueOrNan(organ.now ? organ.now->length : std::nullopt);
  message.area_reduction = valueOrNan(organ.area_reduction);
  message.volume_reduction = valueOrNan(organ.volume_reduction);
  message.length_reduction = valueOrNan(organ.length_reduction);
}

void addCoverage(const CoverageSkill& coverage, vibe_msgs::SkillMetrics& message) {
  message.coverage = valueOrNan(coverage.whole);
  std::transform(coverage.region.begin(), coverage.region.end(), message.coverage_region.begin(), valueOrNan);
  std::transform(coverage.wall.begin(), coverage.wall.end(), message.coverage_wall.begin(), valueOrNan);
}

void addSkill(const SkillMetrics& skill, vibe_msgs::SkillMetrics& message) {
  addPhases(skill.phases, message);
  addMarks(skill.marks, message);
  addBites(skill.bites, message);
  addOrgan(skill.organ, message);
  message.mild_bleedings = static_cast<std::uint32_t>(skill.bleeding.mild);
  message.brisk_bleedings = static_cast<std::uint32_t>(skill.bleeding.brisk);
}

}  // namespace

vibe_msgs::ProcedureEvent makeEvent(const Event& event, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::ProcedureEvent>(stamp);
  message.kind = static_cast<std::uint8_t>(event.kind);
  message.particle = event.particle;
  message.value = event.value;
  message.text = describe(event);
  return message;
}

vibe_msgs::ProcedureEvent makeWarning(const std::string& text, std::int64_t stamp) {
  Event event;
  event.kind = Event::Kind::Warning;
  vibe_msgs::ProcedureEvent message = makeEvent(event, stamp);
  message.text = text;
  return message;
}

const char* toolStateOf(const State& state, const StepInput& input) {
  if (!state.grip.empty()) return "grip";
  if (input.buttons[Insufflate] && !state.pressure_reached) return "insufflation";
  return state.in_contact ? "contact" : "free";
}

vibe_msgs::ProcedureState makeProcedureState(const TimedSimulation& simulation, const RunStatus& status) {
  auto message = stamped<vibe_msgs::ProcedureState>(simulation.now());
  message.scene = simulation.model().scene.name;
  message.seed = simulation.state().seed;
  message.step = static_cast<std::uint64_t>(simulation.state().step);
  message.step_period = simulation.time().period();
  message.time = simulation.state().time;
  message.origin = toRosTime(simulation.time().origin());
  message.paused = status.paused;
  message.tool_state = toolStateOf(simulation.state(), simulation.input());
  message.held_particles = static_cast<std::uint32_t>(simulation.state().grip.size());
  message.volume = simulation.state().volume;
  message.pressure = simulation.state().pressure;
  addProcedure(simulation.state().procedure, simulation.model().scene, message);
  return message;
}

vibe_msgs::SkillMetrics makeSkillMetrics(const TimedSimulation& simulation) {
  const SessionMetrics& metrics = simulation.metrics();
  auto message = stamped<vibe_msgs::SkillMetrics>(simulation.now());
  message.time = metrics.time;
  message.contact_time = metrics.contact_time;
  message.grip_time = metrics.grip_time;
  message.insufflation_time = metrics.insufflation_time;
  message.path_length = metrics.path_length;
  message.max_force = metrics.max_force;
  message.mean_force = metrics.mean_force;
  message.max_volume = metrics.max_volume;
  message.max_pressure = metrics.max_pressure;
  message.max_strain = metrics.max_strain;
  message.energy_balance = metrics.energy_balance;
  message.warnings = static_cast<std::uint32_t>(metrics.warnings());
  addCounts(metrics.events, message);
  addSkill(metrics.skill, message);
  addCoverage(metrics.coverage, message);
  return message;
}

std::string kindOf(const TimedSimulation& simulation, const RunStatus& status) {
  return simulation.model().scene.name + '|' + toolStateOf(simulation.state(), simulation.input()) + '|' +
         std::to_string(simulation.state().grip.size()) + (status.paused ? "|paused|" : "|") +
         std::to_string(countWithoutContact(simulation.metrics().events));
}

}  // namespace vibe::sim
