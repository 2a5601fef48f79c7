#include <CLI/CLI.hpp>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>

#include "firmware_peer.hpp"
#include "lockstep.hpp"

// Runs the firmware of the haptic device in lock-step with a simulated motor and a hand.

using namespace vibe_firmware;

namespace {

const std::map<std::string, std::function<std::unique_ptr<Scenario>()>> kScenarios = {
    {"hostile", hostileScenario}, {"passive", passiveScenario}, {"release", releaseScenario}};

struct Options {
  std::string scenario;
  std::vector<std::string> fifos;
  std::vector<std::string> compare;
  std::string trace;
  std::string table;
  std::uint32_t ticks = 0;
  std::uint32_t delay = 0;
};

void addOptions(CLI::App& app, Options& options) {
  std::vector<std::string> names;
  for (const auto& [name, make_scenario] : kScenarios) names.push_back(name);
  app.add_option("scenario", options.scenario,
                 "hostile: random parameters, hand and buttons; passive: the hand moves to and fro against a constant "
                 "spring and damper; release: the hand lets go of a spring-damper")
      ->check(CLI::IsMember(names));
  app.add_option("--fifos", options.fifos, "FIFOs of an emulator: replies, requests; without: the firmware runs here")
      ->expected(2);
  app.add_option("--ticks", options.ticks, "number of ticks; without: that of the scenario");
  app.add_option("--delay", options.delay, "ticks by which the torque comes late, to see a bound violated");
  app.add_option("--trace", options.trace, "file for what the firmware has answered");
  app.add_option("--table", options.table, "file for the motion after the release, relative to the displacement (CSV)");
  app.add_option("--compare", options.compare, "compare two such files instead; status 1 if they differ")->expected(2);
}

int compare(const Options& options) {
  const std::string difference = firstDifference(readTrace(options.compare[0]), readTrace(options.compare[1]));
  if (!difference.empty()) std::cout << difference << "\n";
  return difference.empty() ? 0 : 1;
}

std::unique_ptr<FirmwarePeer> makePeer(const Options& options) {
  if (options.fifos.empty()) return std::make_unique<LocalPeer>();
  return std::make_unique<FifoPeer>(options.fifos[0], options.fifos[1]);
}

void writeTable(const Scenario& scenario, const std::string& file) {
  std::ofstream out(file);
  if (!scenario.writeTable(out)) throw std::runtime_error("--table: only the scenario release has a table");
  if (!out.flush()) throw std::runtime_error(file + " cannot be written");
}

int run(const Options& options) {
  const std::unique_ptr<Scenario> scenario = kScenarios.at(options.scenario)();
  const std::unique_ptr<FirmwarePeer> firmware = makePeer(options);
  Lockstep lockstep(*firmware, *scenario, options.delay);
  lockstep.run(options.ticks > 0 ? options.ticks : scenario->ticks());
  if (!options.trace.empty()) writeTrace(options.trace, lockstep.trace());
  if (!options.table.empty()) writeTable(*scenario, options.table);
  std::cout << "ticks: " << lockstep.trace().size() << "\n"
            << "trace: " << std::hex << std::setfill('0') << std::setw(16) << lockstep.hash() << std::dec << "\n";
  if (!options.fifos.empty())
    std::cout << "period, shortest and longest [40 ns]: " << lockstep.shortestPeriod() << " "
              << lockstep.longestPeriod() << "\n";
  const bool good = scenario->judge(std::cout);
  std::cout << "verdict: " << (good ? "within bounds" : "out of bounds") << "\n";
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Runs the firmware of the haptic device in lock-step with a simulated motor and a hand. Exit status 1: a "
      "bound of the scenario is violated; 2: wrong use, or no answer from the firmware."};
  Options options;
  addOptions(app, options);
  try {
    app.parse(argc, argv);
    if (options.scenario.empty() == options.compare.empty())
      throw std::runtime_error("name either a scenario or --compare; --help lists them");
    return options.compare.empty() ? run(options) : compare(options);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::cerr << "vibe_cosim: " << error.what() << " (--help lists what there is)\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "vibe_cosim: " << error.what() << "\n";
    return 2;
  }
}
