// Steps the simulator through the inputs of a recording, without a roscore, and compares the hash with the recorded
// one.
#include <cstdio>
#include <string>

#include "recording.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_replay BAG\n"
    "Repeats a recorded session from its topics scene and applied_input, without a roscore, and prints its summary "
    "with the state hash.\n"
    "Ends with 0 if the recording's own hash is the same or cannot be compared, with 1 if it differs, with 2 if the "
    "recording cannot be repeated.\n";

/// @return 0 if the hash is the recorded one, or there is none to compare it with
int compare(const Recording& recording, const std::string& result) {
  const auto recorded = recording.hashes.find(recording.inputs.size());
  if (recorded == recording.hashes.end()) {
    std::printf("the recording has no hash for its last step to compare with\n");
    return 0;
  }
  if (!recording.comparable) {
    std::printf("recorded hash: %s, by an older release whose hash covers other fields: not compared\n",
                recorded->second.c_str());
    return 0;
  }
  const bool same = recorded->second == result;
  std::printf("recorded hash: %s, %s\n", recorded->second.c_str(), same ? "the same" : "NOT the same");
  return same ? 0 : 1;
}

std::shared_ptr<const Model> buildRecorded(const Recording& recording, const std::string& file) {
  Scene scene;
  try {
    scene = parseScene(recording.scene, file + " (topic scene)");
  } catch (const Error& error) {
    throw Error("Recording '" + file + "' has a scene that this build cannot read: " + error.what() +
                " (If an older release recorded it, replay it with that release.)");
  }
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  return buildModel(scene, urdf);
}

int replay(const std::string& file) {
  const Recording recording = readRecording(file);
  Simulation simulation(buildRecorded(recording, file));
  const auto steps = static_cast<std::int64_t>(recording.inputs.size());
  const double duration = static_cast<double>(steps) * simulation.stepPeriod(), begin = steadyTime();
  simulation.run(
      steps, [&](double) { return recording.inputs[static_cast<std::size_t>(simulation.stepCount())]; },
      [&](const Simulation& s) {
        if (s.stepCount() % 600 != 0) return;
        std::printf("\rrepeated %.0f of %.0f s", s.time(), duration);
        std::fflush(stdout);
      });
  std::printf("\rrepeated %lld steps, %.2f s      \n", static_cast<long long>(steps), simulation.time());
  std::fputs(runSummary(simulation.metrics(), simulation.timer().cpu.all, simulation.model().particle_count,
                        simulation.time(), steadyTime() - begin, simulation.hash())
                 .c_str(),
             stdout);
  return compare(recording, toHex(simulation.hash()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string argument = argc == 2 ? argv[1] : "";
  if (argument == "--help") {
    std::fputs(kHelp, stdout);
    return 0;
  }
  if (argument.empty() || argument[0] == '-') {
    std::fputs("vibe_replay: takes one recording; see --help.\n", stderr);
    return 2;
  }
  try {
    return replay(argument);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_replay: %s\n", error.what());
    return 2;
  }
}
