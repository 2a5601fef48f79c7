// Writes a trainee script that performs a whole sleeve gastroplasty on a scene, by performing it: for scenes whose
// stomach or device is not the default one, and for the scripts that ship.
#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/trainee/esg_plan.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_plan --output FILE [options]\n"
    "Performs a sleeve gastroplasty on a scene, looking where the wall is before every motion, and writes what the "
    "hands\n"
    "did as a trainee script.\n"
    "  --scene FILE    scene (default: package://vibe_core/scenes/stomach.yaml)\n"
    "  --style WORD    expert (default), novice, or states: marks, a burn and one set\n"
    "  --sets N        sutures instead of the style's\n"
    "  --bites N       bites per suture instead of the style's\n"
    "  --output FILE   the script\n"
    "  --events        also print what happens\n"
    "  --help          this text\n";

struct Options {
  std::string scene = "package://vibe_core/scenes/stomach.yaml", style = "expert", output;
  int sets = 0, bites = 0;
  bool events = false;
};

int toCount(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || value < 1 || value > 64)
    throw Error("--" + option + " '" + text + "' is no number from 1 to 64; see --help.");
  return static_cast<int>(value);
}

Options parse(int argc, char** argv) {
  static const option kOptions[] = {
      {"scene", 1, nullptr, 's'},  {"style", 1, nullptr, 't'},  {"sets", 1, nullptr, 'n'}, {"bites", 1, nullptr, 'b'},
      {"output", 1, nullptr, 'o'}, {"events", 0, nullptr, 'e'}, {"help", 0, nullptr, 'h'}, {nullptr, 0, nullptr, 0}};
  Options o;
  opterr = 0;
  for (int c; (c = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    const std::string value = optarg == nullptr ? "" : optarg;
    if (c == 's') o.scene = value;
    if (c == 't') o.style = value;
    if (c == 'n') o.sets = toCount("sets", value);
    if (c == 'b') o.bites = toCount("bites", value);
    if (c == 'o') o.output = value;
    if (c == 'e') o.events = true;
    if (c == 'h') {
      std::cout << kHelp;
      std::exit(0);
    }
    if (c == '?')
      throw Error("Option '" + std::string(argv[optind - 1]) + "' is unknown or lacks its value; see --help.");
  }
  if (optind < argc) throw Error("'" + std::string(argv[optind]) + "' is no option; see --help.");
  if (o.output.empty()) throw Error("There is no --output; name the file for the script.");
  if (o.style != "expert" && o.style != "novice" && o.style != "states")
    throw Error("--style '" + o.style + "' is unknown; use expert, novice or states.");
  return o;
}

EsgStyle novice() {
  EsgStyle style;
  style.sets = 3;
  style.bites = 5;
  style.distal_first = false;
  style.pace = 0.6;
  style.aim_error = 4e-3;
  style.turns = 1.5;
  style.drawn = 3e-3;
  style.attempts = 2;
  style.looks = false;
  style.marks = 2;
  style.burn_time = 14;
  style.cinch_part = 0.3;
  style.mistakes = true;
  return style;
}

// Everything that can be seen in a sleeve, once: marks, a burn, one set from its first bite to the cinch.
EsgStyle demonstration() {
  EsgStyle style;
  style.bites = 5;
  style.only_set = 3;
  style.spread = 0.7;
  style.pace = 1.4;
  style.marks = 3;
  style.mark_spread = 1.0;
  style.mark_time = 1;
  style.burn_time = 13.5;
  style.burnt_mark = 7;  // on the posterior wall, which is seen through the anterior one
  return style;
}

EsgStyle styleOf(const Options& o) {
  EsgStyle style = o.style == "novice" ? novice() : o.style == "states" ? demonstration() : EsgStyle();
  if (o.sets > 0) style.sets = o.sets;
  if (o.bites > 0) style.bites = o.bites;
  return style;
}

std::string titleOf(const std::string& style) {
  if (style == "novice") return "A beginner's sleeve";
  if (style == "states") return "Marks, a burn and one set, tagged and cinched";
  return "An experienced endoscopist's sleeve";
}

std::string headerOf(const Options& o) {
  const bool novice = o.style == "novice";
  return "# " + titleOf(o.style) + ", written by `vibe_plan --style " + o.style +
         "`. Format: docs/trainee_scripts.md.\n" + "name: " + (o.style == "states" ? "five_states" : o.style) +
         "\nseed: " + (novice ? "2" : "1") +
         "\n\ntremor:                       # size: design choice; band: physiological tremor of the hand "
         "(Elble & Randall 1976)\n"
         "  frequency: [8 Hz, 12 Hz]\n  amplitude:                  # root mean square\n    insertion: 0.05 mm\n"
         "    rotation: 0.1 deg\n    tip_up_down: 0.1 deg\n    tip_left_right: 0.1 deg\n    helix_advance: 0.02 mm\n" +
         (novice ? "  scale: 4\n" : "") + "\n";
}

int run(const Options& o) {
  const Scene scene = loadScene(resolveAddress(o.scene));
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  ScriptRecorder rehearsal(buildModel(scene, urdf, {}), headerOf(o));
  rehearsal.on_event = [&o](const Event& event) {
    if (o.events) std::fprintf(stderr, "%8.2f s  %s: %s\n", event.time, toString(event.kind), describe(event).c_str());
  };
  performEsg(styleOf(o), rehearsal, [&rehearsal](const std::string& what) {
    std::fprintf(stderr, "%8.2f s  %s\n", rehearsal.state().time, what.c_str());
  });
  std::ofstream file(o.output);
  file << rehearsal.script();
  file.flush();
  if (!file) throw Error("'" + o.output + "' cannot be written; check its folder.");
  std::printf("%.2f s of simulated time, state hash: %s\n", rehearsal.state().time,
              toHex(hash(rehearsal.state())).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_plan: %s\n", error.what());
    return 2;
  }
}
