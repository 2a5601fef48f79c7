#include <iostream>
#include <sstream>

#include "numbers/number_study.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"

namespace vibe::vision::evidence {
namespace {

struct Options {
  StudyOptions study;
  std::string csv;
  bool list = false;
};

int run(Options options) {
  if (options.list) {
    for (const TrackerNumber& n : trackerNumbers())
      std::cout << n.name << " = " << n.of({}) << (n.unit.empty() ? "" : " ") << n.unit << ": " << n.meaning << " ("
                << n.reason << ")\n";
    return 0;
  }
  if (options.study.scenes.empty()) options.study.scenes = studyScenes();
  const auto effects = studyNumbers(options.study, [](const std::string& scene) { std::cerr << scene << "\n"; });
  std::ostringstream table;
  writeEffects(options.csv.empty() ? std::cout : table, effects);
  if (!options.csv.empty()) writeFile(options.csv, table.str(), "The table");
  return 0;
}

int study(int argc, char** argv) {
  CommandLine line(
      "Shifts each number that decides in the tracker and says what moves on synthetic scenes: frames found, errors, "
      "doubts.");
  Options options;
  line.option("--scene", options.study.scenes, "only these scenes of vibe_vision_bench");
  line.option("--number", options.study.numbers, "only these numbers; --list shows them");
  line.option("--factor", options.study.factors, "by which each is multiplied; default: 0.8 1.2");
  line.option("--frames", options.study.frames, "of each scene").check(inRange(2, 100000)).showDefault();
  line.option("--csv", options.csv, "write to this file instead of the standard output");
  line.flag("--list", options.list, "print the numbers and end");
  return runProgram(line, argc, argv, [&] { return run(options); });
}

}  // namespace
}  // namespace vibe::vision::evidence

int main(int argc, char** argv) {
  return vibe::vision::evidence::study(argc, argv);
}
