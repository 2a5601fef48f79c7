// Many trainees perform one protocol: a row of measures per trainee.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/metrics/measures.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/scene/mesh_guess.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/goal_outcomes.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace {

using namespace vibe;

struct Options {
  std::string scene = "package://vibe_core/scenes/stomach.yaml";
  std::string script = "package://vibe_core/trainees/expert.yaml";
  std::string mesh;
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
  app.add_option("--mesh", o.mesh, "surface of the organ instead of the scene's")->type_name("FILE");
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
  std::string name;
  std::string value;
};

std::string text(const std::optional<double>& value) {
  char buffer[32];
  if (!value) return "";
  std::snprintf(buffer, sizeof buffer, "%.6g", *value);
  return buffer;
}

struct MeasureColumn {
  const char* column;
  const char* measure;
};

constexpr MeasureColumn kColumns[] = {{"goals", "goals"},
                                      {"goals_reached", "goals_reached"},
                                      {"sets", "sets"},
                                      {"sets_as_planned", "sets_as_planned"},
                                      {"bites", "bites"},
                                      {"bites_full_thickness", "bites_full_thickness"},
                                      {"bites_torn_out", "tear_outs"},
                                      {"bites_missed", "missed_bites"},
                                      {"bites_withdrawn", "withdrawn_bites"},
                                      {"slips", "slips"},
                                      {"bites_per_5_min", "bites_per_5_min"},
                                      {"bite_spacing_sd [m]", "bite_spacing_sd"},
                                      {"time [s]", "time"},
                                      {"max_force [N]", "max_force"},
                                      {"share_above_5_N", "share_above"},
                                      {"path_length [m]", "path_length"},
                                      {"movements", "movements"},
                                      {"spectral_arc_length", "spectral_arc_length"},
                                      {"log_dimensionless_jerk", "log_dimensionless_jerk"},
                                      {"blood [m3]", "blood_lost"},
                                      {"cinch_tension_mean [N]", "cinch_tension_mean"},
                                      {"area_reduction", "area_reduction"},
                                      {"volume_reduction", "volume_reduction"},
                                      {"length_reduction", "length_reduction"}};

std::vector<Column> columnsOf(const Simulation& simulation, const Trainee& trainee) {
  std::vector<Measure> measures = measuresOf(simulation.metrics(), simulation.state().procedure.sutures);
  for (Measure& measure : goalMeasures(&trainee, simulation.metrics().skill.sets)) measures.push_back(measure);
  std::vector<Column> columns;
  for (const MeasureColumn& c : kColumns) columns.push_back({c.column, text(valueOf(measures, c.measure))});
  columns.push_back({"state_hash", toHex(simulation.hash())});
  return columns;
}

void write(std::FILE* file, const std::vector<Column>& row, bool names) {
  for (std::size_t k = 0; k < row.size(); ++k)
    std::fprintf(file, "%s%s", k > 0 ? "," : "", (names ? row[k].name : row[k].value).c_str());
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
  const std::vector<Column> columns = columnsOf(simulation, trainee);
  row.insert(row.end(), columns.begin(), columns.end());
  return row;
}

std::shared_ptr<const Model> load(const Options& o) {
  Scene scene = loadScene(resolveAddress(o.scene));
  if (!o.mesh.empty()) useMesh(scene, std::filesystem::absolute(resolveAddress(o.mesh)));
  return buildModel(scene, scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "");
}

void run(const Options& o) {
  const std::shared_ptr<const Model> model = load(o);
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
