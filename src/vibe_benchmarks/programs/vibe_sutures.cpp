// Whole procedures of sutures: what each set costs, and what patterns do to the stomach.
#include <getopt.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "suture/pattern_study.hpp"
#include "suture/set_scenario.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_sutures scenarios|patterns [options]\n"
    "  scenarios        14 sets of 4 bites and 8 sets of 7 sewn to the end: CPU time per step of each set\n"
    "  patterns         volume, length and area of the stomach before and after sets of the patterns C, U and Z\n"
    "  --scene FILE     default package://vibe_core/scenes/stomach.yaml\n"
    "  --repeats N      of each scenario, default 3; of each step the cheapest counts\n"
    "  --quick          one run of each scenario; patterns with one tension and width only\n"
    "  --csv FILE       write the rows there (- for standard output)\n"
    "  --help           this text\n"
    "Bites are put into the wall by the program, as the needle would take them; T-tag and cinch go through their "
    "buttons.\n";

struct Options {
  std::string mode, csv, scene = "package://vibe_core/scenes/stomach.yaml";
  int repeats = 3;
  bool quick = false;
};

int numberOf(const std::string& text) {
  std::size_t used = 0;
  int number = 0;
  try {
    number = std::stoi(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || number < 1 || number > 1000)
    throw Error("vibe_sutures: --repeats '" + text + "' is no number from 1 to 1000; give one.");
  return number;
}

Options parse(int argc, char** argv) {
  static const option kOptions[] = {
      {"scene", required_argument, nullptr, 's'}, {"repeats", required_argument, nullptr, 'r'},
      {"quick", no_argument, nullptr, 'q'},       {"csv", required_argument, nullptr, 'o'},
      {"help", no_argument, nullptr, 'h'},        {nullptr, 0, nullptr, 0}};
  Options options;
  for (int c; (c = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    if (c == 's') options.scene = optarg;
    if (c == 'r') options.repeats = numberOf(optarg);
    if (c == 'q') options.quick = true;
    if (c == 'o') options.csv = optarg;
    if (c == 'h') {
      std::cout << kHelp;
      std::exit(0);
    }
    if (c == '?') throw Error("vibe_sutures: unknown option; see --help.");
  }
  if (optind + 1 == argc) options.mode = argv[optind];
  if (options.mode != "scenarios" && options.mode != "patterns")
    throw Error("vibe_sutures: say one of scenarios and patterns; see --help.");
  if (options.quick) options.repeats = 1;
  return options;
}

Scene sceneOf(const Options& options) {
  Scene scene = loadScene(resolveAddress(options.scene));
  if (!scene.gas || !scene.scope || !scene.suture)
    throw Error(options.scene + ": needs the sections gas, scope and suture to be sewn; add them.");
  return scene;
}

template <class Write>
void save(const std::string& file, const Write& write) {
  if (file.empty()) return;
  if (file == "-") return write(std::cout);
  std::ofstream out(file);
  write(out);
  out.close();
  if (!out) throw Error(file + ": cannot be written; give --csv a path in a writable folder.");
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
  std::cerr << processorName() << ", one thread steps, one more prepares factors; the cheapest of " << options.repeats
            << (options.repeats == 1 ? " run\n" : " runs\n");
  for (const ScenarioResult& result : results) printScenario(result, std::cerr);
  save(options.csv, [&](std::ostream& out) { writeScenarios(results, out); });
}

void runPatterns(const Options& options) {
  const auto rows = studyPatterns(sceneOf(options), options.quick, std::cerr);
  printPatterns(rows, std::cerr);
  save(options.csv, [&](std::ostream& out) { writePatterns(rows, out); });
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = parse(argc, argv);
    options.mode == "scenarios" ? runScenarios(options) : runPatterns(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
