#include "bench/bench_cell.hpp"

#include <algorithm>
#include <map>

#include "bench/bench_scene.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::evidence {
namespace {

using Frames = std::vector<RenderedFrame>;

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

bool chosen(const BenchOptions& options, const std::string& method) {
  return options.methods.empty() ||
         std::find(options.methods.begin(), options.methods.end(), method) != options.methods.end();
}

std::vector<std::unique_ptr<Method>> methodsOf(const BenchOptions& options) {
  std::vector<std::unique_ptr<Method>> methods = allMethods();
  const auto unwanted = [&](const std::unique_ptr<Method>& method) { return !chosen(options, method->name()); };
  methods.erase(std::remove_if(methods.begin(), methods.end(), unwanted), methods.end());
  return methods;
}

}  // namespace

std::vector<RenderedFrame> renderFrames(const BenchScene& scene, const Cell& cell, int count) {
  const Renderer renderer(scene.scene);
  const HarderScene* harder = findHarderScene(cell.scene);
  Frames frames;
  frames.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    frames.push_back(renderer.render(static_cast<std::uint64_t>(i)));
    if (harder && harder->retouch) harder->retouch(scene.scene, frames.back());
  }
  return frames;
}

CellResult runCell(const Cell& cell, const BenchOptions& options) {
  const std::vector<std::unique_ptr<Method>> methods = methodsOf(options);
  std::vector<Scorer> scorers;
  for (const auto& method : methods) scorers.emplace_back(*method, options.limits);
  std::vector<double> track, search;
  for (const std::uint64_t seed : options.seeds) {
    const BenchScene scene = makeBenchScene(cell, seed);
    const Frames frames = renderFrames(scene, cell, options.frames);
    std::map<std::size_t, std::vector<MarkerBound>> bounds;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::size_t instrument = methods[m]->instrument(scene);
      if (bounds.count(instrument) == 0) bounds[instrument] = boundsOf(scene, instrument, frames, options.bound_stride);
      const MethodRun run = methods[m]->run(scene, frames);
      scorers[m].add(scene, frames, run, bounds[instrument]);
    }
    if (chosen(options, "ring") && chosen(options, "sleeve")) timeBoth(scene, frames, track, search);
  }
  CellResult result{cell, {}, summarise(track), summarise(search)};
  for (const Scorer& scorer : scorers) result.scores.push_back(scorer.score());
  return result;
}

void writeCsvHeader(std::ostream& out) {
  out << "scene,marker_px,exposure_s,width,height,method,frames,visible,tracked,reports,wrong,hidden,phantom,rms_px,"
         "bias_px,"
         "rotation_rms_deg,bound_px,bound_ratio,nees,nees_low,nees_high,lead_rms_m,track_min_s,track_median_s,search_"
         "min_s,"
         "search_median_s,searched,search_found,search_wrong\n";
}

void writeCsv(std::ostream& out, const CellResult& result) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  const Cell& c = result.cell;
  const auto begin = [&](const std::string& method) -> std::ostream& {
    return out << c.scene << ',' << c.marker << ',' << c.exposure.value_or(0) << ',' << c.width << ',' << c.height
               << ',' << method;
  };
  for (const Score& s : result.scores) {
    begin(s.method);
    for (const double value : {s.frames,   s.visible,      s.tracked,      s.reports,      s.wrong,
                               s.hidden,   s.phantom,      s.rms,          s.bias,         kDegrees * s.rotation_rms,
                               s.bound,    s.boundRatio(), s.nees,         s.nees_low,     s.nees_high,
                               s.lead_rms, s.track.least,  s.track.median, s.search.least, s.search.median,
                               s.searched, s.search_found, s.search_wrong})
      out << ',' << value;
    out << '\n';
  }
  begin("both") << std::string(17, ',') << result.track.least << ',' << result.track.median << ','
                << result.search.least << ',' << result.search.median << ",,," << std::endl;
}

}  // namespace vibe::vision::evidence
