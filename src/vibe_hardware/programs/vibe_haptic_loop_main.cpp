// vibe_haptic_loop: how well the haptic device renders the tissue. Runs simulator, firmware, mechanics and hand in one
// closed loop in virtual time, and compares the force with that of a simulation of a thousand steps per second.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_hardware/emulator/hand.hpp"
#include "vibe_hardware/emulator/haptic_loop.hpp"

namespace {

using namespace vibe;
using namespace vibe::hardware;

struct Options {
  std::string scene = "package://vibe_core/scenes/stomach.yaml", script, csv;
  std::string config = "package://vibe_hardware/config/devices.yaml";
  double from = 0, latency = 5e-3;
};

void addOptions(OptionList& line, Options& o) {
  line.option("--scene", o.scene, "scene to run (default: " + o.scene + ")").typeName("FILE");
  line.option("--script", o.script, "trainee script that the hand plays").typeName("FILE").required();
  line.option("--config", o.config, "calibration of the devices (default: " + o.config + ")").typeName("FILE");
  line.option("--from", o.from, "measure from this time on; the hand should be still there (default: 0)")
      .typeName("S")
      .check(finiteFrom(0));
  line.option("--latency", o.latency, "from the end of a frame to its parameters in the device (default: 0.005)")
      .typeName("S")
      .check(finiteFrom(0));
  line.option("--csv", o.csv, "write one row per millisecond to FILE.spring.csv and FILE.held.csv").typeName("FILE");
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File openCsv(const std::string& part) {
  File out(std::fopen(part.c_str(), "w"), std::fclose);
  if (!out) throw std::runtime_error(part + " cannot be written; choose another file.");
  return out;
}

void writeCsv(std::FILE* out, const HapticLoopResult& result) {
  std::fprintf(out, "time,insertion,rendered,felt,frame,reference,motor\n");
  for (const HapticLoopSample& s : result.samples)
    if (s.measured)
      std::fprintf(out, "%.3f,%.6f,%.5f,%.5f,%.5f,%.5f,%.3e\n", s.time, s.insertion, s.rendered, s.felt, s.frame,
                   s.reference, s.motor);
}

void print(const char* name, const HapticLoopResult& result) {
  const RenderingError error = renderingError(result.samples);
  std::printf("%-8s error %.1f mN of %.0f mN, delay %.1f ms; on the hand %.1f mN\n", name, 1e3 * error.rendered,
              1e3 * error.change, 1e3 * error.delay, 1e3 * error.felt);
  std::printf("         energy of the motor %.2f mJ, at most %.2f mJ; of the tissue %.2f mJ\n",
              1e3 * error.motor_energy, 1e3 * error.most_energy, 1e3 * error.tissue_energy);
  std::printf("         %d sets, %d clamped, %d refused, passivity controller in %d ms; at most %.0f N/m, %.2f N s/m\n",
              result.parameter_sets, result.clamped, result.refused, result.passivity_acts, result.max_stiffness,
              result.max_damping);
  if (result.thread_tension > 0) std::printf("         thread at %.2f N at the end\n", result.thread_tension);
}

void run(const Options& o) {
  const Scene scene = loadScene(resolveAddress(o.scene));
  const TraineeScript script = TraineeScript::load(resolveAddress(o.script));
  HapticLoopSettings settings;
  settings.setup.calibration = Calibration::load(o.config);
  settings.hand = std::make_shared<ScriptedHand>(script);
  settings.duration = script.duration();
  settings.measure_from = o.from;
  settings.latency = o.latency;
  struct Part {
    Rendering rendering;
    const char* name;
    std::unique_ptr<WholeFile> whole;
    File csv;
  };
  std::vector<Part> parts;
  parts.push_back({Rendering::Spring, "spring", nullptr, File(nullptr, std::fclose)});
  parts.push_back({Rendering::Held, "held", nullptr, File(nullptr, std::fclose)});
  for (Part& part : parts) {  // before the loop runs, which takes minutes
    if (o.csv.empty()) break;
    part.whole = std::make_unique<WholeFile>(o.csv + "." + part.name + ".csv", "The table");
    part.csv = openCsv(part.whole->part());
  }
  for (Part& part : parts) {
    settings.rendering = part.rendering;
    const HapticLoopResult result = runHapticLoop(scene, settings);
    print(part.name, result);
    if (!part.csv) continue;
    writeCsv(part.csv.get(), result);
    part.whole->finish(std::ferror(part.csv.get()) == 0 && std::fclose(part.csv.release()) == 0);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{"Compares the force of the haptic device with that of a simulation of a thousand steps per second.",
                   "vibe_haptic_loop"};
  addOptions(line, options);
  return runProgram(line, argc, argv, [&options] { run(options); });
}
