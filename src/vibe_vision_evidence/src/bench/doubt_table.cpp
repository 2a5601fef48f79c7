#include "bench/doubt_table.hpp"

#include <cmath>

#include "bench/bench_cell.hpp"

namespace vibe::vision::evidence {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kWrongPlace = 5, kWrongTurn = 3 * kDegree;  // [px], [rad]
constexpr double kHidden = 0.25, kDeviations = 5;

bool isWrong(const Estimate& estimate, const SyntheticTruth& truth, bool sleeve) {
  if (truth.visible < kHidden) return true;
  const auto off = [](double error, double variance, double most) {
    return std::abs(error) > std::min(most, kDeviations * std::sqrt(variance));
  };
  if (off(estimate.along - truth.along, estimate.covariance(0, 0), kWrongPlace)) return true;
  return sleeve &&
         off(std::remainder(estimate.rotation - truth.rotation, 360 * kDegree), estimate.covariance(1, 1), kWrongTurn);
}

std::vector<std::string> allScenes() {
  std::vector<std::string> names = sceneNames();
  for (const HarderScene& scene : faultyScenes()) names.push_back(scene.name);
  return names;
}

}  // namespace

void DoubtRow::add(const BenchScene& bench, const std::vector<RenderedFrame>& drawn, const TrackerPolicy& policy) {
  const MethodRun run = makeOwnMethod(sleeve, policy, drawn.size())->run(bench, drawn);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Estimate& estimate = run.estimates[i];
    ++frames;
    if (!estimate.found) continue;
    ++reports;
    const bool is_wrong = isWrong(estimate, drawn[i].truth[sleeve ? bench.sleeve : bench.ring], sleeve);
    wrong += is_wrong ? 1 : 0;
    silent += is_wrong && estimate.doubt == Doubt::None ? 1 : 0;
    needless += !is_wrong && estimate.doubt != Doubt::None && estimate.doubt != Doubt::Unchecked ? 1 : 0;
  }
}

std::vector<DoubtRow> doubtTable(const std::vector<std::string>& scenes, const std::vector<std::uint64_t>& seeds,
                                 int frames) {
  std::vector<DoubtRow> rows;
  for (const std::string& name : scenes.empty() ? allScenes() : scenes) {
    DoubtRow pair[2] = {{name, false}, {name, true}};
    const Cell cell{name};
    for (const std::uint64_t seed : seeds) {
      const BenchScene scene = makeBenchScene(cell, seed);
      const std::vector<RenderedFrame> drawn = renderFrames(scene, cell, frames);
      for (DoubtRow& row : pair) row.add(scene, drawn);
    }
    rows.insert(rows.end(), pair, pair + 2);
  }
  return rows;
}

void writeDoubts(std::ostream& out, const std::vector<DoubtRow>& rows) {
  out << "| scene | marker | frames | reports | wrong | wrong without doubt | right, but doubted |\n|"
      << "---|---|---|---|---|---|---|\n";
  for (const DoubtRow& row : rows)
    out << "| " << row.scene << " | " << (row.sleeve ? "sleeve" : "ring") << " | " << row.frames << " | " << row.reports
        << " | " << row.wrong << " | " << row.silent << " | " << row.needless << " |\n";
}

}  // namespace vibe::vision::evidence
