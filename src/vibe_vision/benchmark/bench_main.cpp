#include <fstream>
#include <iostream>
#include <opencv2/core/utility.hpp>

#include "bench_cell.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"

namespace vision = vibe::vision;

namespace {

struct Options {
  vision::BenchOptions bench;
  std::vector<std::string> scenes;
  std::vector<double> markers, exposures;
  double speed = 0.5;
  std::vector<int> sensor;
  std::string csv, trace;
  bool quick = false, list = false;
};

void addOptions(vibe::OptionList& line, Options& options) {
  line.option("--scene", options.scenes, "only these scenes; --list shows them");
  line.option("--marker", options.markers, "sizes of the markers [px] instead of 40").check(vibe::inRange(12, 80));
  line.option("--exposure", options.exposures, "instead of the scene's [ms]").check(vibe::inRange(0.01, 6.5));
  line.option("--speed", options.speed, "peak speed [m/s]").check(vibe::inRange(0.01, 0.75));
  line.option("--sensor", options.sensor, "width and height [px]").expected(2);
  line.option("--frames", options.bench.frames, "frames per seed").check(vibe::inRange(2, 100000));
  line.option("--seed", options.bench.seeds, "seeds of motion, noise and background; default: 1 2 3");
  line.option("--visible", options.bench.limits.visible, "share of a marker from which on it should be found")
      .check(vibe::inRange(0.25, 1.0));
  line.option("--method", options.bench.methods, "only these methods")
      .check(vibe::oneOf({"ring", "sleeve", "centroid", "aruco", "apriltag", "apriltag_unrefined"}));
  line.flag("--quick", options.quick, "60 frames of one seed of every scene; no sizes, exposures and sensors");
  line.flag("--list", options.list, "print the names of the scenes and end");
  line.option("--csv", options.csv, "write all numbers to this file");
  line.option("--trace", options.trace, "write every frame of every method to this file");
}

/// What the options name, or without any everything that docs/vision.md shows.
std::vector<vision::Cell> cellsOf(const Options& options) {
  std::vector<vision::Cell> cells;
  vision::Cell cell;
  cell.speed = options.speed;
  if (!options.sensor.empty()) cell.width = options.sensor[0], cell.height = options.sensor[1];
  const bool chosen = !options.scenes.empty() || !options.markers.empty() || !options.exposures.empty();
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty() && chosen) scenes = {"moving"};
  if (scenes.empty()) scenes = vision::sceneNames();
  for (const std::string& scene : scenes)
    for (const double marker : options.markers.empty() ? std::vector<double>{40} : options.markers)
      for (const double exposure : options.exposures.empty() ? std::vector<double>{0} : options.exposures) {
        cell.scene = scene;
        cell.marker = marker;
        cell.exposure = exposure > 0 ? std::optional<double>(1e-3 * exposure) : std::nullopt;
        cells.push_back(cell);
      }
  if (chosen || options.quick) return cells;
  const std::vector<vision::Cell> more = vision::furtherCells();
  cells.insert(cells.end(), more.begin(), more.end());
  return cells;
}

std::ofstream openOutput(const std::string& option, const std::string& path) {
  std::ofstream file;
  if (path.empty()) return file;
  file.open(path);
  if (!file) throw vibe::Error(option + ": cannot write to '" + path + "'; name a file in a folder that exists");
  return file;
}

int run(const Options& options) {
  if (options.list) {
    for (const std::string& name : vision::sceneNames()) std::cout << name << "\n";
    for (const std::string& name : vision::harderSceneNames()) std::cout << name << "\n";
    return 0;
  }
  std::ofstream csv = openOutput("--csv", options.csv), trace = openOutput("--trace", options.trace);
  vision::BenchOptions bench = options.bench;
  if (trace.is_open()) {
    bench.trace = &trace;
    vision::writeTraceHeader(trace);
  }
  if (!vision::pinThread()) std::cerr << "The thread cannot be pinned to one processor: times may vary more.\n";
  vision::printHeader(std::cout, options.bench.limits);
  std::vector<vision::CellResult> results;
  for (const vision::Cell& cell : cellsOf(options)) {
    results.push_back(vision::runCell(cell, bench));
    vision::printCell(std::cout, results.back());
  }
  if (csv.is_open()) vision::writeCsv(csv, results);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(0);
  vibe::CommandLine line{
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
