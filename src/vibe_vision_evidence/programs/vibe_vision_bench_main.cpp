#include <fstream>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "bench/bench_cell.hpp"
#include "bench/doubt_table.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision::evidence {
namespace {

struct Options {
  BenchOptions bench;
  std::vector<std::string> scenes;
  std::string csv;
  bool quick = false, list = false, doubts = false;
};

void addOptions(OptionList& line, Options& options) {
  line.option("--scene", options.scenes, "only these scenes; --list shows them");
  line.option("--frames", options.bench.frames, "frames per seed").check(inRange(2, 100000));
  line.option("--seed", options.bench.seeds, "seeds of motion, noise and background; default: 1 2 3");
  line.option("--method", options.bench.methods, "only these methods")
      .check(oneOf({"ring", "sleeve", "centroid", "aruco", "apriltag"}));
  line.flag("--quick", options.quick, "60 frames of one seed of every scene; no sizes, exposures and sensors");
  line.flag("--doubts", options.doubts, "only print how often a wrong report has no doubt, and a right one has");
  line.flag("--list", options.list, "print the names of the scenes and end");
  line.option("--csv", options.csv, "write to this file instead of the standard output");
}

/// What the options name, or without any everything that docs/vision.md shows.
std::vector<Cell> cellsOf(const Options& options) {
  std::vector<Cell> cells;
  if (options.scenes.empty() && !options.quick) cells = furtherCells();
  for (const std::string& scene : options.scenes.empty() ? sceneNames() : options.scenes) cells.push_back({scene});
  return cells;
}

int run(const Options& options) {
  if (options.list) {
    for (const std::string& name : sceneNames()) std::cout << name << "\n";
    for (const HarderScene& scene : harderScenes()) std::cout << scene.name << "\n";
    for (const HarderScene& scene : faultyScenes()) std::cout << scene.name << "\n";
    return 0;
  }
  if (options.doubts) {
    writeDoubts(std::cout, doubtTable(options.scenes, options.bench.seeds, options.bench.frames));
    return 0;
  }
  const auto whole = options.csv.empty() ? nullptr : std::make_unique<WholeFile>(options.csv, "--csv");
  std::ofstream file;  // of the part that is written to
  if (whole) file.open(whole->part());
  if (!file) throw Error("--csv: cannot write to '" + options.csv + "'; name a file in a folder that exists");
  if (!pinThread()) std::cerr << "The thread cannot be pinned to one processor: times may vary more.\n";
  std::ostream& csv = options.csv.empty() ? std::cout : file;
  writeCsvHeader(csv);
  for (const Cell& cell : cellsOf(options)) {
    std::cerr << cell.scene << "\n";
    writeCsv(csv, runCell(cell, options.bench));
  }
  if (whole) file.close(), whole->finish(file.good());
  return 0;
}

int benchmark(int argc, char** argv) {
  cv::setNumThreads(0);
  CommandLine line{
      "Accuracy, robustness and processor time of the trackers beside ArUco, AprilTag and a centroid, on the "
      "same rendered frames with known truth."};
  Options options;
  addOptions(line, options);
  return vibe::runProgram(line, argc, argv, [&] {
    if (options.quick && !line.isGiven("--frames")) options.bench.frames = 60;
    if (options.quick && !line.isGiven("--seed")) options.bench.seeds = {1};
    return run(options);
  });
}

}  // namespace
}  // namespace vibe::vision::evidence

int main(int argc, char** argv) {
  return vibe::vision::evidence::benchmark(argc, argv);
}
