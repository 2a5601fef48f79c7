// Measures steps in contact: speed beside the error against a time-converged motion, and the hard cases.
#include <algorithm>
#include <iostream>
#include <sstream>
#include <string>

#include "contact/contact_table.hpp"
#include "contact/grip_refinement.hpp"
#include "contact/hard_cases.hpp"
#include "contact/rest_search.hpp"
#include "contact/way_counts.hpp"
#include "output/result_row.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace {

using namespace vibe;
using namespace vibe::benchmarks;

struct Options {
  std::string csv, scene = "package://vibe_core/scenes/stomach.yaml";
  std::vector<std::string> names;
  std::vector<int> rate{60}, iterations, threads{1};
  std::vector<double> radius;
  // 8 iterations do not solve the steps in which a fold snaps: the end of a frame is then off by 7 % of the motion
  int reference_rate = 960, reference_iterations = 30, repeats = 1;
  std::string steps;
  std::vector<std::string> scripts;
  double duration = 1e9;
  std::vector<std::uint64_t> seeds{1};
  std::vector<int> particles{1000, 2000, 3618, 8000, 16000};
  int sites = 6, poses = 30;
  double hold = 4;
  bool brief = false;
  bool no_reference = false, stages = false, real_time = false, plain_preparation = false;
};

OptionCheck rateOfFrames() {
  return {[](const std::string& text) {
    const int rate = std::atoi(text.c_str());
    return rate >= 60 && rate % 60 == 0 ? std::string() : text + " is not a multiple of 60, the rate of the frames";
  }};
}

OptionList addStates(OptionList& line, Options& o) {
  OptionList states = line.subcommand("states", "speed and error of states with contact:\n" + describeContactStates());
  states.option("STATE", o.names, "states (default: all); the free pull is always measured")
      .typeName("")
      .check(oneOf(contactStateNames()).hidden());
  states.option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  states.option("--rate", o.rate, "steps per second, a multiple of 60; several: one setting each (default: 60)")
      .typeName("HZ")
      .check(rateOfFrames());
  states.option("--iterations", o.iterations, "tissue.iterations; one, or one per rate (default: the scene's)")
      .typeName("N")
      .check(wholeFrom(1, 1000));
  states.option("--spectral-radius", o.radius, "one, or one per rate (default: the scene's)")
      .typeName("R")
      .check(inRange(0.0, 1.0).hidden());
  states.option("--reference-rate", o.reference_rate, "steps per second of the reference (default: 960)")
      .typeName("HZ")
      .check(rateOfFrames());
  states.option("--reference-iterations", o.reference_iterations, "of the reference (default: 30)")
      .typeName("N")
      .check(wholeFrom(1, 1000));
  states.flag("--no-reference", o.no_reference, "times only");
  states
      .option("--threads", o.threads,
              "used inside a step; several: each, in turn, and the bits must be the same (default: 1)")
      .typeName("N")
      .check(wholeFrom(1, 1000));
  states.flag("--real-time", o.real_time,
              "a step begins when its time has come, not as soon as the last one has ended");
  states.flag("--plain-preparation", o.plain_preparation,
              "prepare with plain arithmetic: for valgrind, which takes long over fused one");
  states.flag("--stages", o.stages, "print what the steps have spent their time on");
  states.option("--repeats", o.repeats, "runs of each setting (default: 1); of each step the fastest counts")
      .typeName("N")
      .check(wholeFrom(1, 1000));
  states.option("--csv", o.csv, "write the rows there (- for standard output)").typeName("FILE");
  return states;
}

OptionList addHard(OptionList& line, Options& o) {
  OptionList hard = line.subcommand("hard", "cases that no contact may break:\n" + describeHardCases());
  hard.option("CASE", o.names, "cases (default: all)").typeName("").check(oneOf(hardCaseNames()).hidden());
  hard.option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  hard.option("--seed", o.seeds, "of the case random; several: one run each (default: 1)").typeName("N");
  hard.option("--script", o.scripts, "sessions of these trainee scripts; without CASE only they run").typeName("FILE");
  hard.option("--duration", o.duration, "at most so much of a session [s]").typeName("S").check(finiteFrom(0));
  hard.flag("--brief", o.brief, "shorter motions, fewer sets");
  hard.option("--csv", o.csv, "write the rows there (- for standard output)").typeName("FILE");
  hard.option("--steps", o.steps, "write a line per step there").typeName("FILE");
  return hard;
}

std::vector<std::string> wayCaseNames() {
  std::vector<std::string> names = contactStateNames();
  names.insert(names.end(), hardCaseNames().begin(), hardCaseNames().end());
  return names;
}

OptionList addWays(OptionList& line, Options& o) {
  OptionList ways = line.subcommand("ways", "how often steps go on otherwise than foreseen, and what those steps cost");
  ways.option("CASE", o.names, "states and hard cases (default: all states, and sleeve)")
      .typeName("")
      .check(oneOf(wayCaseNames()).hidden());
  ways.option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  ways.flag("--brief", o.brief, "shorter motions, fewer sets");
  ways.option("--csv", o.csv, "write the rows there (- for standard output)").typeName("FILE");
  return ways;
}

OptionList addRefinement(OptionList& line, Options& o) {
  OptionList refinement = line.subcommand("refinement", "force of a pull by 20 mm on finer and finer meshes");
  refinement.option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  refinement.option("--particles", o.particles, "meshes (default: 1000 2000 3618 8000 16000)")
      .typeName("N")
      .check(wholeFrom(100, 200000));
  refinement.option("--sites", o.sites, "places on each, 3 mm apart (default: 6)")
      .typeName("N")
      .check(wholeFrom(1, 30));
  refinement.option("--csv", o.csv, "write the rows there (- for standard output)").typeName("FILE");
  return refinement;
}

OptionList addRest(OptionList& line, Options& o) {
  OptionList rest =
      line.subcommand("rest", "whether the wall rests while the scope is held still, in poses drawn at random");
  rest.option("--scene", o.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  rest.option("--particles", o.particles, "meshes (default: that of the scene)")
      .typeName("N")
      .check(wholeFrom(100, 200000));
  rest.option("--poses", o.poses, "of each mesh (default: 30)").typeName("N").check(wholeFrom(1, 100000));
  rest.option("--seed", o.seeds, "of the poses (default: 1); several: so many poses for each").typeName("N");
  rest.option("--hold", o.hold, "until the second that counts (default: 4) [s]").typeName("S").check(finiteFrom(0));
  rest.option("--csv", o.csv, "write the rows there (default: - for standard output)").typeName("FILE");
  return rest;
}

template <class T>
T entry(const std::vector<T>& list, std::size_t k, const char* option, std::size_t rates, T otherwise) {
  if (list.empty()) return otherwise;
  if (list.size() != 1 && list.size() != rates)
    throw Error(std::string(option) + " has neither one value nor as many as --rate.");
  return list.size() == 1 ? list.front() : list[k];
}

ContactPlan planOf(const Options& o, const Scene& scene) {
  ContactPlan plan;
  plan.names = o.names;
  plan.repeats = o.repeats;
  plan.plain_preparation = o.plain_preparation;
  for (std::size_t k = 0; k < o.rate.size(); ++k)
    for (const int threads : o.threads)
      plan.settings.push_back({o.rate[k],
                               entry(o.iterations, k, "--iterations", o.rate.size(), scene.tissue.iterations),
                               entry(o.radius, k, "--spectral-radius", o.rate.size(), scene.tissue.spectral_radius),
                               o.stages, threads, o.real_time});
  if (!o.no_reference)
    plan.reference = ContactSetting{o.reference_rate, o.reference_iterations, scene.tissue.spectral_radius};
  return plan;
}

Scene sceneOf(const Options& options) {
  Scene scene = loadScene(resolveAddress(options.scene));
  if (!scene.gas || !scene.scope || !scene.suture || !scene.helix)
    throw Error(options.scene + ": needs the sections gas, scope, helix and suture; add them.");
  return scene;
}

void runStates(const Options& options) {
  const Scene scene = sceneOf(options);
  const std::string urdf = readTextFile(resolveAddress(scene.scope->urdf), "URDF");
  const auto rows = runContactStates(scene, urdf, planOf(options, scene), std::cerr);
  std::cerr << "\n" << machineInfo().processor << "\n";
  report(options.csv, [&](std::ostream& out) { writeContactRows(rows, out); });
}

void runHard(const Options& options) {
  const Scene scene = sceneOf(options);
  HardCases cases(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"), options.brief, std::cerr);
  std::ostringstream steps;
  if (!options.steps.empty()) writeHardStepHeader(steps);
  const HardOutput output{options.steps.empty() ? nullptr : &steps, nullptr};
  std::vector<HardResult> results;
  const auto run = [&](const HardCase& hard) {
    results.push_back(runHardCase(hard, output));
    const HardResult& r = results.back();
    std::cerr << formatted("%s: %.2f ms per step, %d crossings, %d pierced\n", r.name.c_str(), r.times.p50, r.crossings,
                           r.pierced);
  };
  const bool all = options.names.empty() && options.scripts.empty();
  for (const std::string& name : all ? hardCaseNames() : options.names)
    for (const std::uint64_t seed : name == "random" || name == "jump" ? options.seeds : std::vector<std::uint64_t>{1})
      run(cases.prepare(name, seed));
  for (const std::string& script : options.scripts) run(cases.session(script, options.duration));
  report(options.csv, [&](std::ostream& out) { writeHardResults(results, out); });
  save(options.steps, [&](std::ostream& out) { out << steps.str(); });
}

void runWays(const Options& options) {
  const Scene scene = sceneOf(options);
  const std::string urdf = readTextFile(resolveAddress(scene.scope->urdf), "URDF");
  std::vector<std::string> names = options.names;
  if (names.empty()) {
    names = contactStateNames();
    names.emplace_back("sleeve");
  }
  ContactStates states(scene, urdf, std::cerr);
  HardCases cases(scene, urdf, options.brief, std::cerr);
  std::vector<WayCounts> counts;
  for (const std::string& name : names) {
    std::cerr << name << std::endl;
    WayCounts& ways = counts.emplace_back(name);
    const auto& known = contactStateNames();
    if (std::find(known.begin(), known.end(), name) != known.end())
      runContact(states.prepare(name), {60, scene.tissue.iterations, scene.tissue.spectral_radius}, &ways);
    else
      runHardCase(cases.prepare(name), {nullptr, &ways});
  }
  save(options.csv.empty() ? "-" : options.csv, [&](std::ostream& out) {
    writeWayHeader(out);
    for (const WayCounts& ways : counts) ways.write(out);
  });
}

void runRefinement(const Options& options) {
  const auto rows = refineGrip(sceneOf(options), options.particles, options.sites, std::cerr);
  report(options.csv, [&](std::ostream& out) { writeRefinement(rows, out); });
}

void runRest(const Options& options, bool one_mesh) {
  Scene scene = sceneOf(options);
  const std::string urdf = readTextFile(resolveAddress(scene.scope->urdf), "URDF");
  std::vector<HeldPose> found;
  for (const int particles : one_mesh ? std::vector<int>{scene.geometry.particles} : options.particles) {
    scene.geometry.particles = particles;
    const auto model = buildModel(scene, urdf);
    std::array<int, 3> count{};
    for (const std::uint64_t seed : options.seeds)
      searchRest(model, options.poses, seed, options.hold, [&](const HeldPose& pose) {
        found.push_back(pose);
        ++count[static_cast<std::size_t>(pose.wall)];
        std::cerr << "\r" << particles << " particles: " << count[0] << " poses rest, " << count[1] << " creep, "
                  << count[2] << " tremble" << std::flush;
      });
    std::cerr << "\n";
  }
  save(options.csv.empty() ? "-" : options.csv, [&](std::ostream& out) {
    writeHeldHeader(out);
    for (const HeldPose& pose : found) writeHeldPose(pose, out);
  });
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{"Measures steps in which something touches.", "vibe_contact"};
  const OptionList states = addStates(line, options);
  const OptionList hard = addHard(line, options);
  const OptionList refinement = addRefinement(line, options);
  const OptionList ways = addWays(line, options);
  const OptionList rest = addRest(line, options);
  line.requireSubcommand();
  return runProgram(line, argc, argv, [&] {
    if (states.isChosen()) runStates(options);
    if (hard.isChosen()) runHard(options);
    if (refinement.isChosen()) runRefinement(options);
    if (ways.isChosen()) runWays(options);
    if (rest.isChosen()) runRest(options, !rest.isGiven("--particles"));
  });
}
