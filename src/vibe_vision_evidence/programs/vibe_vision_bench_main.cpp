#include <fstream>
#include <iostream>
#include <opencv2/core/utility.hpp>

#include "bench/bench_cell.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision::evidence {
namespace {

struct Options {
  BenchOptions bench;
  std::vector<std::string> scenes;
  std::string csv;
  bool quick = false, list = false;
};

void addOptions(OptionList& line, Options& options) {
  line.option("--scene", options.scenes, "only these scenes; --list shows them");
  line.option("--frames", options.bench.frames, "frames per seed").check(inRange(2, 100000));
  line.option("--seed", options.bench.seeds, "seeds of motion, noise and background; default: 1 2 3");
  line.option("--method", options.bench.methods, "only these methods")
      .check(oneOf({"ring", "sleeve", "centroid", "aruco", "apriltag"}));
  line.flag("--quick", options.quick, "60 frames of one seed of every scene; no sizes, exposures and sensors");
  line.flag("--list", options.list, "print the names of the scenes and end");
  line.option("--csv", options.csv, "write all numbers to this file");
}

/// What the options name, or without any everything that docs/vision.md shows.
std::vector<Cell> cellsOf(const Options& options) {
  std::vector<Cell> cells;
  for (const std::string& scene : options.scenes.empty() ? sceneNames() : options.scenes) {
    cells.emplace_back();
    cells.back().scene = scene;
  }
  if (!options.scenes.empty() || options.quick) return cells;
  const std::vector<Cell> more = furtherCells();
  cells.insert(cells.end(), more.begin(), more.end());
  return cells;
}

int run(const Options& options) {
  if (options.list) {
    for (const std::string& name : sceneNames()) std::cout << name << "\n";
    for (const std::string& name : harderSceneNames()) std::cout << name << "\n";
    return 0;
  }
  std::ofstream csv;
  if (!options.csv.empty()) csv.open(options.csv);
  if (!csv) throw Error("--csv: cannot write to '" + options.csv + "'; name a file in a folder that exists");
  if (!pinThread()) std::cerr << "The thread cannot be pinned to one processor: times may vary more.\n";
  printHeader(std::cout, options.bench.limits);
  std::vector<CellResult> results;
  for (const Cell& cell : cellsOf(options)) {
    results.push_back(runCell(cell, options.bench));
    printCell(std::cout, results.back());
  }
  if (csv.is_open()) writeCsv(csv, results);
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
