// Many trainees perform one protocol: a row of measures per trainee.
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace {

using namespace vibe;

struct Options {
  std::string scene = "package://vibe_core/scenes/stomach.yaml";
  std::string script = "package://vibe_core/trainees/expert.yaml";
  std::string csv = "-";
  std::uint64_t first_seed = 1;
  int count = 20;
  std::vector<double> novice{0, 1};
  double duration = 0;
};

void addOptions(CLI::App& app, Options& o) {
  app.add_option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)")->type_name("FILE");
  app.add_option("--script", o.script, "protocol of goals (default: package://vibe_core/trainees/expert.yaml)")
      ->type_name("FILE");
  app.add_option("--csv", o.csv, "write the rows there, appended to what is there (default: standard output)")
      ->type_name("FILE");
  app.add_option("--first-seed", o.first_seed, "seed of the first trainee of each skill (default: 1)")->type_name("N");
  app.add_option("--count", o.count, "trainees per skill (default: 20)")->type_name("N")->check(wholeFrom(1, 100000));
  app.add_option("--novice", o.novice, "skills, 0: expert to 1: novice (default: 0 1)")
      ->type_name("PART...")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--duration", o.duration, "simulated seconds per trainee (default: until the goals have ended)")
      ->type_name("S")
      ->check(finiteFrom(0));
}

struct Column {
  const char* name;
  std::string value;
};

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

std::string text(const std::optional<double>& value) {
  return value ? text(*value) : "";
}

// Sets whose recognised technique is that of the goal.
int countAsPlanned(const Trainee& trainee, const std::vector<SetSkill>& sets) {
  std::size_t k = 0;
  int count = 0;
  for (const Goal& goal : trainee.goals()) {
    const auto* planned = std::get_if<SutureSetGoal>(&goal);
    if (planned == nullptr || k >= sets.size()) continue;
    if (sets[k].named && sets[k].technique == planned->pattern) ++count;
    ++k;
  }
  return count;
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

int countReached(const Trainee& trainee) {
  int count = 0;
  for (const GoalResult& result : trainee.results()) count += result.reached;
  return count;
}

std::vector<Column> measuresOf(const Simulation& simulation, const Trainee& trainee) {
  const SessionMetrics& m = simulation.metrics();
  const SkillMetrics& skill = m.skill;
  const PhaseSkill& whole = skill.phases.whole;
  const std::vector<Suture>& sutures = simulation.state().procedure.sutures;
  return {{"goals", text(static_cast<double>(trainee.goals().size()))},
          {"goals_reached", text(countReached(trainee))},
          {"sets", text(static_cast<double>(skill.sets.size()))},
          {"sets_as_planned", text(countAsPlanned(trainee, skill.sets))},
          {"bites", text(skill.bites.taken)},
          {"bites_full_thickness", text(skill.bites.full_thickness)},
          {"bites_torn_out", text(skill.bites.torn_out)},
          {"bites_missed", text(skill.mistakes.missed_bites)},
          {"bites_withdrawn", text(skill.mistakes.withdrawn_bites)},
          {"slips", text(skill.mistakes.slips)},
          {"bites_per_5_min", text(bitesPerFiveMinutes(sutures))},
          {"bite_spacing_sd [m]", text(skill.bites.spacing_sd)},
          {"time [s]", text(m.time)},
          {"max_force [N]", text(m.max_force)},
          {"share_above_5_N", text(whole.force.share_above)},
          {"path_length [m]", text(m.path_length)},
          {"movements", text(whole.motion.movements)},
          {"spectral_arc_length", text(whole.motion.spectral_arc_length)},
          {"log_dimensionless_jerk", text(whole.motion.log_dimensionless_jerk)},
          {"blood [m3]", text(skill.bleeding.lost)},
          {"cinch_tension_mean [N]", text(meanCinchTension(skill.sets))},
          {"area_reduction", text(skill.organ.area_reduction)},
          {"volume_reduction", text(skill.organ.volume_reduction)},
          {"length_reduction", text(skill.organ.length_reduction)},
          {"state_hash", toHex(simulation.hash())}};
}

void write(std::FILE* file, const std::vector<Column>& row, bool names) {
  for (std::size_t k = 0; k < row.size(); ++k)
    std::fprintf(file, "%s%s", k > 0 ? "," : "", names ? row[k].name : row[k].value.c_str());
  std::fprintf(file, "\n");
  if (std::fflush(file) != 0) throw Error("The table could not be written to its end; check the room on the disk.");
}

std::vector<Column> perform(const Options& o, const std::shared_ptr<const Model>& model, const Protocol& protocol,
                            double novice, std::uint64_t seed) {
  Simulation simulation(model);
  simulation.reset(seed);
  Trainee trainee(model, between(Skill::expert(), Skill::novice(), novice), seed);
  for (const Goal& goal : protocol.goals) trainee.add(goal);
  while (!trainee.done() && (o.duration <= 0 || simulation.time() < o.duration))
    simulation.step(trainee.next(observe(simulation)));
  std::vector<Column> row{{"novice", text(novice)}, {"seed", std::to_string(seed)}};
  const std::vector<Column> measures = measuresOf(simulation, trainee);
  row.insert(row.end(), measures.begin(), measures.end());
  return row;
}

void run(const Options& o) {
  const std::shared_ptr<const Model> model = loadModel(o.scene);
  const Protocol protocol = Protocol::load(resolveAddress(o.script));
  std::FILE* file = o.csv == "-" ? stdout : std::fopen(o.csv.c_str(), "a");
  if (file == nullptr) throw Error("Cannot write " + o.csv + "; name a file in a folder that exists and is writable.");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> closed(file == stdout ? nullptr : file, std::fclose);
  if (file != stdout) std::fseek(file, 0, SEEK_END);
  bool names = file == stdout || std::ftell(file) == 0;
  for (int k = 0; k < o.count; ++k)
    for (const double novice : o.novice) {
      const std::vector<Column> row = perform(o, model, protocol, novice, o.first_seed + static_cast<std::uint64_t>(k));
      if (names) write(file, row, true);
      names = false;
      write(file, row, false);
    }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Trainees of several skills and seeds perform one protocol, one after the other. Writes one row of measures per\n"
      "trainee. Run several at once, with other seeds, to use more cores.",
      "vibe_cohort"};
  addOptions(app, options);
  return runProgram(app, argc, argv, [&] { run(options); });
}
