// Shifts each number that steers a step, and measures what changes.
#include <iostream>
#include <string>

#include "output/result_row.hpp"
#include "policy/policy_study.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace {

using namespace vibe;
using namespace vibe::benchmarks;

struct Options {
  std::vector<std::string> names;
  std::string csv = "-", scene = "package://vibe_core/scenes/stomach.yaml";
};

std::vector<std::string> numberNames() {
  std::vector<std::string> names;
  for (const PolicyNumber& number : policyNumbers()) names.push_back(number.name);
  return names;
}

bool isWanted(const Options& options, const PolicyNumber& number) {
  return options.names.empty() ||
         std::find(options.names.begin(), options.names.end(), number.name) != options.names.end();
}

void study(const Options& options, std::ostream& out) {
  const Scene scene = loadScene(resolveAddress(options.scene));
  if (!scene.gas || !scene.scope || !scene.suture || !scene.helix)
    throw Error(options.scene + ": needs the sections gas, scope, helix and suture; add them.");
  const PolicyStudy policy(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"), std::cerr);
  writePolicyHeader(out);
  writePolicyTotal(policy.total(), out);
  for (const PolicyNumber& number : policyNumbers())
    for (const double factor : {0.8, 1.2})
      if (isWanted(options, number)) writePolicyEffect(number, policy.effectOf(number, factor), out);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{"Multiplies each number that steers a step by 0.8 and by 1.2, and measures what changes:\n" +
                       describePolicyStates(),
                   "vibe_policy"};
  line.option("NUMBER", options.names, "numbers of docs/policy.md (default: all)")
      .typeName("")
      .check(oneOf(numberNames()).hidden());
  line.option("--scene", options.scene, "scene (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  line.option("--csv", options.csv, "write the rows there (default: - for standard output)").typeName("FILE");
  return runProgram(line, argc, argv, [&] { save(options.csv, [&](std::ostream& out) { study(options, out); }); });
}
