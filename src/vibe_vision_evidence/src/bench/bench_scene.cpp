#include "bench/bench_scene.hpp"

namespace vibe::vision::evidence {
namespace {

constexpr double kNominalMarker = 40;                      // [px]
constexpr double kTagSide = 4e-3;                          // [m]
constexpr int kTagId = 7;                                  // of both families
constexpr double kArucoBelow = 132, kAprilTagBelow = 232;  // the ring; look-alikes pass between them [px]

void resize(RingDesign& ring, double factor) {
  ring.outer_diameter *= factor;
  ring.inner_diameter *= factor;
  ring.side *= factor;
}

void resize(SleeveDesign& sleeve, double factor) {
  sleeve.diameter *= factor;
  sleeve.length *= factor;
  for (Bar& bar : sleeve.bars) bar = {bar.begin * factor, bar.end * factor};
  sleeve.helix_begin *= factor;
  sleeve.helix_end *= factor;
  sleeve.helix_pitch *= factor;
}

void resize(TagDesign& tag, double factor) {
  tag.side *= factor;
}

/// Another part of the motion for each seed, and of the pixel grid.
void changeMotion(SyntheticMotion& motion, std::uint64_t seed) {
  const double later = 0.613 * static_cast<double>(seed - 1);
  const auto slide = motion.slide, rotation = motion.rotation;
  motion.slide = [=](double time) { return slide(time + later); };
  if (rotation) motion.rotation = [=](double time) { return rotation(time + later); };
}

void indexMarkers(BenchScene& bench) {
  for (std::size_t i = 0; i < bench.scene.instruments.size(); ++i)
    (std::holds_alternative<SleeveDesign>(bench.scene.instruments[i].nominal.marker) ? bench.sleeve : bench.ring) = i;
}

/// A tag that moves as the ring does, on an axis of its own below it. @return its index
std::size_t addTag(BenchScene& bench, const TagDesign& tag, double below) {
  SyntheticInstrument instrument = bench.scene.instruments[bench.ring];
  instrument.nominal.name = tagFamilyName(tag.family);
  instrument.nominal.axis.origin.y() += below;
  setTag(instrument, tag);
  bench.scene.instruments.push_back(instrument);
  return bench.scene.instruments.size() - 1;
}

}  // namespace

void enlarge(SyntheticScene& scene, int width, int height) {
  const Eigen::Vector2d shift(0.5 * (width - scene.camera.width), 0.5 * (height - scene.camera.height));
  scene.camera.width = width;
  scene.camera.height = height;
  scene.camera.cx += shift.x();
  scene.camera.cy += shift.y();
  for (SyntheticInstrument& instrument : scene.instruments) instrument.nominal.axis.origin += shift;
}

BenchScene makeBenchScene(const Cell& cell, std::uint64_t seed) {
  BenchScene bench;
  const HarderScene* harder = findHarderScene(cell.scene);
  bench.scene = namedScene(harder ? harder->base : cell.scene);
  bench.scene.seed = seed;
  if (cell.exposure) bench.scene.degradation.exposure = *cell.exposure;
  if (cell.width > 0) enlarge(bench.scene, cell.width, cell.height);
  const double factor = cell.marker / kNominalMarker;
  for (SyntheticInstrument& instrument : bench.scene.instruments) {
    std::visit([&](auto& marker) { resize(marker, factor); }, instrument.nominal.marker);
    changeMotion(instrument.motion, seed);
    instrument.nominal.axis.origin += static_cast<double>(seed - 1) * Eigen::Vector2d(0.37, 0.21);
  }
  indexMarkers(bench);
  bench.aruco = addTag(bench, {TagFamily::Aruco, kTagId, kTagSide * factor}, kArucoBelow);
  bench.apriltag = addTag(bench, {TagFamily::AprilTag, kTagId, kTagSide * factor}, kAprilTagBelow);
  if (harder) harder->change(bench.scene, seed);
  bench.config = nominalConfig(bench.scene);
  bench.config.instruments = {bench.scene.instruments[bench.sleeve].nominal,
                              bench.scene.instruments[bench.ring].nominal};
  return bench;
}

std::vector<Cell> furtherCells() {
  std::vector<Cell> cells;
  for (const char* scene : {"static", "moving"})
    for (const double marker : {16.0, 24.0, 32.0, 64.0}) cells.push_back({scene, marker});
  const Cell moving{"moving"};
  for (const double exposure : {0.1e-3, 0.2e-3, 0.5e-3, 1e-3, 2e-3, 4e-3})
    cells.push_back({moving.scene, moving.marker, exposure});
  cells.push_back({moving.scene, moving.marker, std::nullopt, 1936, 1216});
  return cells;
}

}  // namespace vibe::vision::evidence
