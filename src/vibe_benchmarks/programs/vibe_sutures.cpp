// Simulates complete suturing procedures: the cost of each set, and the effect of stitch patterns on the stomach.
#include <algorithm>
#include <iostream>
#include <string>

#include "output/result_row.hpp"
#include "suture/outcome_study.hpp"
#include "suture/set_scenario.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace {

using namespace vibe;
using namespace vibe::benchmarks;

const char kAbout[] =
    "Sews whole procedures of sutures.\n"
    "  scenarios  14 sets of 4 bites and 8 sets of 7 to the end: CPU time per step of each set\n"
    "  outcomes   what an idealised sleeve of C, U and Z changes at rest, and which modelling choices matter\n"
    "The program puts bites into the wall as the needle would take them; T-tag and cinch go through their buttons.";

struct Options {
  std::string mode, csv, scene = "package://vibe_core/scenes/stomach.yaml";
  std::vector<std::string> trials;
  int repeats = 3;
  bool quick = false;
};

void addOptions(OptionList& line, Options& o) {
  line.option("scenarios|outcomes", o.mode, "what to sew")
      .typeName("")
      .required()
      .check(oneOf({"scenarios", "outcomes"}).hidden());
  line.option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  line.option("--repeats", o.repeats, "runs of each scenario (default: 3); of each step the fastest counts")
      .typeName("N")
      .check(wholeFrom(1, 1000));
  line.option("--trial", o.trials, "only these outcomes, by the columns trial and pattern, as in fine_mesh_u")
      .typeName("TRIAL_PATTERN");
  line.flag("--quick", o.quick, "one run of each scenario; outcomes with nothing varied");
  line.option("--csv", o.csv, "write the rows there (- for standard output)").typeName("FILE");
}

Scene sceneOf(const Options& options) {
  Scene scene = loadScene(resolveAddress(options.scene));
  if (!scene.gas || !scene.scope || !scene.suture)
    throw Error(options.scene + ": needs the sections gas, scope and suture to be sewn; add them.");
  return scene;
}

void runScenarios(const Options& options) {
  const Scene scene = sceneOf(options);
  const auto model = buildModel(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"));
  SetLayout many, long_sets;
  many.sets = 14, many.bites = 4;
  long_sets.sets = 8, long_sets.bites = 7;
  std::vector<ScenarioResult> results;
  results.push_back(runScenario(model, long_sets, "8x7", options.repeats, std::cerr));
  results.back().reference = 17.7;  // Erden et al., on an Intel i7-12700KF
  results.push_back(runScenario(model, many, "14x4", options.repeats, std::cerr));
  results.back().reference = 18.0;
  std::cerr << machineInfo().processor << ", one thread steps, one more prepares factors; the cheapest of "
            << options.repeats << (options.repeats == 1 ? " run\n" : " runs\n");
  for (const ScenarioResult& result : results)
    std::cerr << formatted("%s: %.1f times real time, walls %s\n", result.name.c_str(), result.real_time_factor,
                           result.crossed ? "CROSS one another" : "do not cross");
  report(options.csv, [&](std::ostream& out) { writeScenarios(results, out); });
}

std::vector<OutcomeTrial> chosenTrials(const Scene& scene, const Options& options) {
  const std::vector<OutcomeTrial> all = outcomeTrials(scene, options.quick);
  if (options.trials.empty()) return all;
  std::vector<OutcomeTrial> chosen;
  for (const std::string& name : options.trials) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const OutcomeTrial& trial) {
      return trial.name + "_" + toString(trial.pattern) == name;
    });
    if (found == all.end()) throw Error("--trial: there is no '" + name + "'; without the option all run by name.");
    chosen.push_back(*found);
  }
  return chosen;
}

void runOutcomes(const Options& options) {
  const Scene scene = sceneOf(options);
  OutcomeStudy study(scene);
  std::vector<OutcomeRow> rows;
  for (const OutcomeTrial& trial : chosenTrials(scene, options)) {
    rows.push_back(study.run(trial));
    std::cerr << trial.name << ", " << toString(trial.pattern) << std::endl;
    save(options.csv, [&](std::ostream& out) { writeOutcomes(rows, out); });
  }
  report("", [&](std::ostream& out) { writeOutcomes(rows, out); });
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{kAbout, "vibe_sutures"};
  addOptions(line, options);
  return runProgram(line, argc, argv, [&] {
    if (options.quick) options.repeats = 1;
    if (options.mode == "scenarios") runScenarios(options);
    if (options.mode == "outcomes") runOutcomes(options);
  });
}
