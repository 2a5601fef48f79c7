// vibe_arm_energy: the energy that an arm gives to the hand over a link with delay, jitter and loss, with and without
// the passivity controller of crtk_teleop, and what crtk_teleop says. Prints the table of docs/hardware.md.
#include <boost/algorithm/string/join.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_hardware/emulator/arm_loop.hpp"

namespace {

using namespace vibe;
using namespace vibe::hardware;

struct Options {
  std::string mapping = "package://vibe_hardware/config/arms/touch.yaml";
  double duration = 10;
};

/// Over all hands and tissues.
struct Row {
  ArmLoopResult worst;
  double without = 0;   // most energy with no controller [J]
  bool silent = false;  // some case is beyond the bound, and nothing was said that names why
};

bool namesWhy(const ArmLoopResult& result) {
  return result.warnings.size() > result.warnings.count("held back");
}

Row play(const TeleopMapping& mapping, const ArmLink& link, double duration) {
  Row row;
  row.worst.beyond = -1e9;
  TeleopMapping free = mapping;
  for (HandJoint& joint : free.joints) joint.port.capacity = 1e9, joint.port.damping_limit = 0;
  const std::vector<HandAtArm> hands = {swayingHand(8e-3, 1), swayingHand(8e-3, 4), lightHand(0.02, 1),
                                        lightHand(0.01, 3), yieldingHand(0.02)};
  for (const double stiffness : {50.0, 300.0, 2000.0})
    for (const HandAtArm& hand : hands) {
      const ArmLoopResult with = runArmLoop({mapping, link, hand, stiffness, duration});
      row.without = std::max(row.without, runArmLoop({free, link, hand, stiffness, duration}).most);
      row.silent |= with.beyond > 0 && !namesWhy(with);
      row.worst.most = std::max(row.worst.most, with.most);
      row.worst.beyond = std::max(row.worst.beyond, with.beyond);
      row.worst.warnings.insert(with.warnings.begin(), with.warnings.end());
    }
  return row;
}

struct Case {
  std::string what;
  ArmLink link;  // the delays are added
};

/// @param delay  as the mapping says it [s]. @param there, back  as they are [s]
void print(const TeleopMapping& mapping, const Case& c, double delay, double there, double back, double duration) {
  ArmLink link = c.link;
  link.measurements = there;
  link.forces = back;
  TeleopMapping stated = mapping;
  for (HandJoint& joint : stated.joints) joint.port.delay = delay;
  stated.timeout = std::max(stated.timeout, there + 0.1);
  const Row row = play(stated, link, duration);
  const std::string said = boost::algorithm::join(row.worst.warnings, ", ");
  std::printf("| %s | %.0f, %.0f | %.0f | %.1f | %.1f | %.0f | %s%s |\n", c.what.c_str(), 1e3 * there, 1e3 * back,
              1e3 * delay, 1e3 * row.worst.most, 1e3 * row.worst.beyond, 1e3 * row.without, said.c_str(),
              row.silent ? "; **nothing in a case that is beyond**" : "");
}

void run(const Options& o) {
  const std::string urdf = "package://vibe_description/urdf/scope.urdf";
  const TeleopMapping mapping = loadTeleopMapping(resolveAddress(o.mapping), loadToolLimits(resolveAddress(urdf)));
  const std::vector<Case> cases = {{"steady", {}},
                                   {"jitter", {0, 0, 1}},
                                   {"jitter, a tenth lost", {0, 0, 1, 0.1}},
                                   {"80 ms without, every 2 s", {0, 0, 0, 0, 0.08}},
                                   {"400 ms without, every 2 s", {0, 0, 0, 0, 0.4}}};
  std::printf(
      "| link | delay there, back [ms] | `delay` [ms] | most energy [mJ] | beyond the bound by at most [mJ] | "
      "without controller [mJ] | said |\n|---|---|---|---|---|---|---|\n");
  for (const double delay : {0.01, 0.03, 0.1})
    for (const Case& c : cases) print(mapping, c, delay + 0.005, delay, delay, o.duration);
  for (const double delay : {0.03, 0.1}) print(mapping, cases[0], 0.01, delay, delay, o.duration);
  print(mapping, cases[0], 0.01, 0, 0.03, o.duration);
  TeleopMapping slower = mapping;
  for (HandJoint& joint : slower.joints) joint.port.speed_limit = 0.2;
  print(slower, {"steady, the hand 2.5 times as fast as `speed_limit`", {}}, 0.035, 0.03, 0.03, o.duration);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{"Measures the energy that an arm gives to the hand over links with delay, jitter and loss.",
                   "vibe_arm_energy"};
  line.option("--mapping", options.mapping, "of the arm (default: " + options.mapping + ")").typeName("FILE");
  line.option("--duration", options.duration, "of each of the cases (default: 10)").typeName("S").check(finiteFrom(0));
  return runProgram(line, argc, argv, [&options] { run(options); });
}
