#include "bench_cell.hpp"

#include <map>

#include "harder_scenes.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe {
namespace {

using Frames = std::vector<RenderedFrame>;

Frames renderFrames(const BenchScene& scene, const HarderScene* harder, int count) {
  const Renderer renderer(scene.scene);
  Frames frames;
  frames.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    frames.push_back(renderer.render(static_cast<std::uint64_t>(i)));
    if (harder && harder->retouch) harder->retouch(scene.scene, frames.back());
  }
  return frames;
}

/// Only of frames in which the marker is fully visible: the bound of a hidden one is infinite.
std::vector<MarkerBound> boundsOf(const BenchScene& scene, std::size_t instrument, const Frames& frames, int stride) {
  std::vector<MarkerBound> bounds;
  for (std::size_t i = 0; i < frames.size(); i += static_cast<std::size_t>(stride))
    if (frames[i].truth[instrument].visible > 0.99) bounds.push_back(cramerRaoBound(scene.scene, instrument, i));
  return bounds;
}

void timeBoth(const BenchScene& scene, const Frames& frames, std::vector<double>& track, std::vector<double>& search) {
  Tracker tracker(scene.config), searcher(scene.config);
  for (const RenderedFrame& frame : frames) {
    double begin = threadCpuTime();
    tracker.track(frame.frame);
    track.push_back(threadCpuTime() - begin);
    searcher.reset();
    begin = threadCpuTime();
    searcher.track(frame.frame);
    search.push_back(threadCpuTime() - begin);
  }
}

std::vector<std::unique_ptr<Method>> methodsOf(const BenchOptions& options) {
  std::vector<std::unique_ptr<Method>> methods = allMethods();
  if (!options.tags) methods.resize(3);
  return methods;
}

}  // namespace

CellResult runCell(const Cell& cell, const BenchOptions& options) {
  const std::vector<std::unique_ptr<Method>> methods = methodsOf(options);
  std::vector<Scorer> scorers;
  for (const auto& method : methods) scorers.emplace_back(*method, options.limits);
  std::vector<double> track, search;
  for (const std::uint64_t seed : options.seeds) {
    const BenchScene scene = makeBenchScene(cell, seed);
    const Frames frames = renderFrames(scene, findHarderScene(cell.scene), options.frames);
    std::map<std::size_t, std::vector<MarkerBound>> bounds;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::size_t instrument = methods[m]->instrument(scene);
      if (bounds.count(instrument) == 0) bounds[instrument] = boundsOf(scene, instrument, frames, options.bound_stride);
      scorers[m].add(scene, frames, methods[m]->run(scene, frames), bounds[instrument]);
    }
    timeBoth(scene, frames, track, search);
  }
  CellResult result{cell, {}, summarise(track), summarise(search)};
  for (const Scorer& scorer : scorers) result.scores.push_back(scorer.score());
  return result;
}

}  // namespace vibe
