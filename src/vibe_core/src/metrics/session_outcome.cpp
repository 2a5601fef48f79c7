#include "vibe_core/metrics/session_outcome.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

using Kind = Event::Kind;

class Table {
 public:
  std::vector<Measure> rows;

  void add(std::string name, const char* unit, std::optional<double> value) {
    if (value && !std::isfinite(*value)) value.reset();
    rows.push_back({std::move(name), unit, value});
  }
  void count(const char* name, int value) { add(name, "1", value); }
};

void addSession(const SessionMetrics& m, Table& table) {
  const PhaseSkill& whole = m.skill.phases.whole;
  table.add("time", "s", m.time);
  table.add("contact_time", "s", m.contact_time);
  table.add("grip_time", "s", m.grip_time);
  table.add("insufflation_time", "s", m.insufflation_time);
  table.add("path_length", "m", m.path_length);
  table.add("log_dimensionless_jerk", "1", whole.motion.log_dimensionless_jerk);
  table.add("spectral_arc_length", "1", whole.motion.spectral_arc_length);
  table.count("movements", whole.motion.movements);
  table.count("submovements", whole.motion.submovements);
  table.add("economy", "1", whole.motion.economy);
  table.add("max_force", "N", m.max_force);
  table.add("mean_force", "N", m.mean_force);
  table.add("time_above", "s", whole.force.time_above);
  table.add("share_above", "1", whole.force.share_above);
  table.add("volume", "m^3", m.volume);
  table.add("max_volume", "m^3", m.max_volume);
  table.add("pressure", "Pa", m.pressure);
  table.add("max_pressure", "Pa", m.max_pressure);
  table.add("max_strain", "1", m.max_strain);
}

void addEnergies(const SessionMetrics& m, Table& table) {
  const EnergyAccount& e = m.energy;
  table.add("tool_work", "J", e.tool_work);
  table.add("gas_work", "J", e.gas_work);
  table.add("thread_work", "J", e.thread_work);
  table.add("pull_work", "J", e.pull_work);
  table.add("friction_loss", "J", e.friction_loss);
  table.add("damping_loss", "J", e.damping_loss);
  table.add("viscous_loss", "J", e.viscous_loss);
  table.add("contact_loss", "J", e.contact_loss);
  table.add("numerical_loss", "J", e.numerical_loss);
  table.add("relaxation_loss", "J", m.relaxation_loss);
  table.add("correction_work", "J", e.correction_work);
  table.add("residual_work", "J", e.residual_work);
  table.add("energy_balance", "J", m.energy_balance);
}

void addPhase(const std::string& phase, const PhaseSkill& skill, Table& table) {
  const MotionMeasures& motion = skill.motion;
  const std::optional<double> max_force =
      skill.force.loaded_time > 0 ? std::optional<double>(skill.force.max) : std::nullopt;
  table.add("phase_time." + phase, "s", skill.time);
  table.add("phase_path_length." + phase, "m", motion.path_length);
  table.add("phase_log_dimensionless_jerk." + phase, "1", motion.log_dimensionless_jerk);
  table.add("phase_spectral_arc_length." + phase, "1", motion.spectral_arc_length);
  table.add("phase_submovements." + phase, "1", motion.submovements);
  table.add("phase_economy." + phase, "1", motion.economy);
  table.add("phase_max_force." + phase, "N", max_force);
  table.add("phase_mean_force." + phase, "N", skill.force.mean);
  table.add("phase_time_above." + phase, "s", skill.force.time_above);
}

void addCounts(const SessionMetrics& m, Table& table) {
  table.count("grabs", m.events.of(Kind::Grab));
  table.count("missed_grabs", m.events.of(Kind::GrabMissed));
  table.count("releases", m.events.of(Kind::Release));
  table.count("slips", m.events.of(Kind::Slip));
  table.count("missed_bites", m.events.of(Kind::BiteMissed));
  table.count("withdrawn_bites", m.events.of(Kind::BiteWithdrawn));
  table.count("broken_threads", m.events.of(Kind::ThreadBroke));
  table.count("overdue_bleedings", m.events.of(Kind::BleedingOverdue));
  table.count("rejected", m.events.of(Kind::Rejected));
  table.count("warnings", m.warnings());
}

void addMarks(const MarkSkill& marks, Table& table) {
  const auto on = [&marks](Wall wall) { return marks.wall[static_cast<std::size_t>(wall)]; };
  table.count("mark_zones", marks.zones);
  table.count("mark_zones_inside", marks.inside);
  table.count("mark_zones_anterior", on(Wall::Anterior));
  table.count("mark_zones_greater_curvature", on(Wall::GreaterCurvature));
  table.count("mark_zones_posterior", on(Wall::Posterior));
  table.count("burn_zones", marks.burns);
  table.count("deep_burn_zones", marks.deep_burns);
}

void addBites(const BiteSkill& bites, Table& table) {
  table.count("bites", bites.taken);
  table.count("tear_outs", bites.torn_out);
  table.count("bites_full_thickness", bites.full_thickness);
  table.add("bite_spacing_mean", "m", bites.spacing_mean);
  table.add("bite_spacing_sd", "m", bites.spacing_sd);
  table.add("bite_depth_mean", "m", bites.depth_mean);
  table.add("bite_depth_sd", "m", bites.depth_sd);
  table.add("full_thickness_share", "1", bites.full_thickness_share);
  table.count("bites_in_antrum", bites.in_antrum);
  table.count("bites_in_fundus", bites.in_fundus);
  table.add("bites_proximal", "1", bites.bites_proximal);
  table.add("sets_proximal", "1", bites.sets_proximal);
}

std::optional<double> meanCinchTension(const std::vector<SetSkill>& sets) {
  double sum = 0;
  int count = 0;
  for (const SetSkill& set : sets)
    if (set.cinch_tension) sum += *set.cinch_tension, ++count;
  if (count == 0) return {};
  return sum / count;
}

// From the first to the last bite of each set, with one bite less: the pace of suturing, without insufflation and
// cinch.
std::optional<double> bitesPerFiveMinutes(const std::vector<Suture>& sutures) {
  double time = 0;
  int bites = 0;
  for (const Suture& suture : sutures) {
    if (suture.bites.size() < 2) continue;
    time += suture.bites.back().time - suture.bites.front().time;
    bites += static_cast<int>(suture.bites.size()) - 1;
  }
  if (!(time > 0)) return {};
  return 300 * bites / time;
}

void addSets(const std::vector<SetSkill>& sets, const std::vector<Suture>& sutures, Table& table) {
  table.count("sets", static_cast<int>(sets.size()));
  table.add("cinch_tension_mean", "N", meanCinchTension(sets));
  table.add("bites_per_5_min", "1", bitesPerFiveMinutes(sutures));
}

void addBleeding(const BleedingSkill& bleeding, Table& table) {
  table.count("mild_bleedings", bleeding.mild);
  table.count("brisk_bleedings", bleeding.brisk);
  table.count("bleeding", bleeding.now);
  table.add("blood_lost", "m^3", bleeding.lost);
}

void addOrgan(const OrganSkill& organ, Table& table) {
  table.add("reference_pressure", "Pa", organ.reference_pressure);
  table.add("organ_pressure", "Pa", organ.pressure);
  table.add("lumen_area", "m^2", organ.now ? organ.now->mean_area : std::nullopt);
  table.add("organ_length", "m", organ.now ? organ.now->length : std::nullopt);
  table.add("area_reduction", "1", organ.area_reduction);
  table.add("volume_reduction", "1", organ.volume_reduction);
  table.add("length_reduction", "1", organ.length_reduction);
}

void addCoverage(const CoverageSkill& coverage, Table& table) {
  table.add("coverage", "1", coverage.whole);
  for (int k = 0; k < kRegionCount; ++k)
    table.add(std::string("coverage.") + toString(static_cast<Region>(k)), "1",
              coverage.region[static_cast<std::size_t>(k)]);
  const std::array<const char*, kWallCount> walls{"anterior", "greater_curvature", "posterior", "lesser_curvature"};
  for (std::size_t k = 0; k < walls.size(); ++k) table.add(std::string("coverage.") + walls[k], "1", coverage.wall[k]);
}

}  // namespace

std::vector<Measure> measuresOf(const SessionMetrics& metrics, const std::vector<Suture>& sutures) {
  Table table;
  addSession(metrics, table);
  addEnergies(metrics, table);
  for (int k = 0; k < kPhaseCount; ++k)
    addPhase(toString(static_cast<Phase>(k)), metrics.skill.phases.phase[static_cast<std::size_t>(k)], table);
  addCounts(metrics, table);
  addMarks(metrics.skill.marks, table);
  addBites(metrics.skill.bites, table);
  addSets(metrics.skill.sets, sutures, table);
  addBleeding(metrics.skill.bleeding, table);
  addOrgan(metrics.skill.organ, table);
  addCoverage(metrics.coverage, table);
  return std::move(table.rows);
}

std::optional<double> valueOf(const std::vector<Measure>& measures, const std::string& name) {
  for (const Measure& measure : measures)
    if (measure.name == name) return measure.value;
  throw Error("There is no measure '" + name + "'; docs/metrics.md lists them.");
}

std::string toJson(const SessionOutcome& outcome) {
  using Json = nlohmann::ordered_json;
  Json measures = Json::object(), events = Json::object(), goals = Json::array();
  for (const Measure& m : outcome.measures)
    measures[m.name] = {{"value", m.value ? Json(*m.value) : Json()}, {"unit", m.unit}};
  for (int k = 0; k < kEventKindCount; ++k) {
    const auto kind = static_cast<Event::Kind>(k);
    events[toString(kind)] = outcome.events.of(kind);
  }
  for (const GoalOutcome& g : outcome.goals)
    goals.push_back({{"goal", g.goal}, {"reached", g.reached}, {"reason", g.reason}});
  const Json json{{"measures", measures},
                  {"events", events},
                  {"goals", goals},
                  {"steps", outcome.steps},
                  {"state_hash", toHex(outcome.state_hash)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";  // what is not a number becomes null
}

}  // namespace vibe
