// Runs a scene under a trainee script without ROS: CSV out, summary and state hash at the end. For sweeps and tests.
#include <getopt.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/common/step_timer.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/metrics/session_csv.hpp"
#include "vibe_core/scene/mesh_guess.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_headless [options]\n"
    "Runs a scene under a trainee script as fast as possible, without a roscore.\n"
    "  --scene FILE      scene to run (default: package://vibe_core/scenes/stomach.yaml)\n"
    "  --script FILE     what the trainee does (default: nothing)\n"
    "  --mesh FILE       organ from this surface instead of the scene's\n"
    "  --duration S      simulated seconds (default: the script's length, else 10)\n"
    "  --csv FILE        one row per step (default: none; - for standard output)\n"
    "  --snapshot FILE   write the last state there\n"
    "  --threads N       threads inside a step (default 1); does not change the result\n"
    "  --seed N          instead of the scene's\n"
    "  --quiet           print the state hash only\n"
    "  --script-length   print how long the script is [s], and end\n"
    "  --help            this text\n";

struct Options {
  std::string scene = "package://vibe_core/scenes/stomach.yaml";
  std::string script, mesh, csv, snapshot;
  double duration = 0;
  int threads = 1;
  std::string seed;
  bool quiet = false;
  bool script_length = false;
};

double toNumber(const std::string& option, const std::string& text, double lowest) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= lowest) || !std::isfinite(value))
    throw Error("--" + option + " '" + text + "' is no number of at least " + std::to_string(lowest) + "; see --help.");
  return value;
}

Options parse(int argc, char** argv) {
  static const option kOptions[] = {
      {"scene", 1, nullptr, 's'},         {"script", 1, nullptr, 't'}, {"mesh", 1, nullptr, 'm'},
      {"duration", 1, nullptr, 'd'},      {"csv", 1, nullptr, 'c'},    {"snapshot", 1, nullptr, 'p'},
      {"threads", 1, nullptr, 'n'},       {"seed", 1, nullptr, 'e'},   {"quiet", 0, nullptr, 'q'},
      {"script-length", 0, nullptr, 'l'}, {"help", 0, nullptr, 'h'},   {nullptr, 0, nullptr, 0}};
  Options o;
  opterr = 0;
  for (int c; (c = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    const std::string value = optarg == nullptr ? "" : optarg;
    switch (c) {
      case 's':
        o.scene = value;
        break;
      case 't':
        o.script = value;
        break;
      case 'm':
        o.mesh = value;
        break;
      case 'd':
        o.duration = toNumber("duration", value, 0);
        break;
      case 'c':
        o.csv = value;
        break;
      case 'p':
        o.snapshot = value;
        break;
      case 'n':
        o.threads = static_cast<int>(toNumber("threads", value, 1));
        break;
      case 'e':
        o.seed = value;
        break;
      case 'q':
        o.quiet = true;
        break;
      case 'l':
        o.script_length = true;
        break;
      case 'h':
        std::cout << kHelp;
        std::exit(0);
      default:
        throw Error("Option '" + std::string(argv[optind - 1]) + "' is unknown or lacks its value; see --help.");
    }
  }
  if (optind < argc) throw Error("'" + std::string(argv[optind]) + "' is no option; see --help.");
  return o;
}

std::shared_ptr<const Model> load(const Options& o) {
  Scene scene = loadScene(resolveAddress(o.scene));
  const std::string guesses = o.mesh.empty() ? "" : useMesh(scene, o.mesh);
  if (!guesses.empty()) std::fprintf(stderr, "%s\n", guesses.c_str());
  if (!o.seed.empty()) scene.seed = static_cast<std::uint64_t>(toNumber("seed", o.seed, 0));
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  const bool show = !o.quiet && isatty(STDERR_FILENO) == 1;
  return buildModel(scene, urdf, [show](const std::string& what, double fraction) {
    if (show) std::fprintf(stderr, "\r%3.0f %% %-60s%s", 100 * fraction, what.c_str(), fraction >= 1 ? "\n" : "");
  });
}

std::unique_ptr<TraineeScript> loadScript(const Options& o) {
  if (o.script.empty()) return nullptr;
  return std::make_unique<TraineeScript>(TraineeScript::load(resolveAddress(o.script)));
}

void printProgress(double time, double duration, const TraineeScript* script) {
  const std::string doing = script == nullptr ? "" : script->phaseAt(time);
  std::fprintf(stderr, "\r%7.2f of %.2f s  %-30s", time, duration, doing.c_str());
}

int printScriptLength(const Options& o) {
  if (o.script.empty()) throw Error("--script-length needs a --script.");
  std::printf("%.3f\n", loadScript(o)->duration());
  return 0;
}

void printEvents(const std::vector<Event>& events, bool over_progress) {
  for (const Event& event : events)
    std::fprintf(stderr, "%s%7.2f s  %s: %s\n", over_progress ? "\r" : "", event.time, toString(event.kind),
                 describe(event).c_str());
}

int run(const Options& o) {
  if (o.script_length) return printScriptLength(o);
  const std::shared_ptr<const Model> model = load(o);
  const std::unique_ptr<TraineeScript> script = loadScript(o);
  const std::string softness = softnessWarning(*model);
  if (!softness.empty()) std::fprintf(stderr, "%s\n", softness.c_str());
  const double duration = o.duration > 0 ? o.duration : (script ? script->duration() : 10);
  const std::unique_ptr<SessionCsv> csv = o.csv.empty() ? nullptr : std::make_unique<SessionCsv>(o.csv);
  const bool show = !o.quiet && isatty(STDERR_FILENO) == 1;

  SimulationSettings settings;
  settings.threads = o.threads;
  Simulation simulation(model, settings);
  const double begin = steadyTime();
  simulation.run(
      std::lround(duration / simulation.stepPeriod()),
      [&](double time) { return script ? script->at(time) : StepInput{}; },
      [&](const Simulation& s) {
        if (csv) csv->write(*model, s.state(), s.events());
        if (!o.quiet) printEvents(s.events(), show);
        if (show && s.stepCount() % 30 == 1) printProgress(s.time(), duration, script.get());
      });
  if (show) std::fprintf(stderr, "\r%-60s\r", "");
  if (!o.snapshot.empty()) simulation.saveSnapshot(o.snapshot);
  if (o.quiet)
    std::cout << "state hash: " << toHex(simulation.hash()) << "\n";
  else
    std::cout << runSummary(simulation.metrics(), simulation.timer().cpu.all, model->particle_count, simulation.time(),
                            steadyTime() - begin, simulation.hash());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_headless: %s\n", error.what());
    return 2;
  }
}
