#pragma once

#include <string>
#include <vector>

#include "bench/bench_scene.hpp"
#include "bench/method.hpp"
#include "bound/marker_bound.hpp"

namespace vibe::vision::evidence {

/// Keeps the calling thread on the processor it runs on. @return false where the system does not allow it
bool pinThread();

/// Of a set of times, all in the same unit; NaN for an empty set.
struct TimeSummary {
  double least = 0, median = 0;
};
TimeSummary summarise(std::vector<double> times);

/// What counts as visible and as wrong.
struct ScoreLimits {
  double visible = 0.5;   ///< share of the marker's area from which on a method should find it
  double phantom = 0.25;  ///< share below which a report is a phantom
  double outlier = 5;     ///< errors above are no precision; they are counted as wrong instead [px]
  double wrong = 0.5e-3;  ///< [m]
};

/// Of one method in one cell, over all seeds. NaN where nothing was measured.
struct Score {
  std::string method;
  double frames = 0, visible = 0, tracked = 0;  ///< numbers of frames
  double reports = 0, wrong = 0, doubted = 0;
  double hidden = 0, phantom = 0;
  double searched = 0, search_found = 0, search_wrong = 0;
  double rms = 0, bias = 0, rotation_rms = 0;    ///< [px], [px], [rad]
  double bound = 0;                              ///< Cramer-Rao, RMS of the frames where it was computed [px]
  double nees = 0, nees_low = 0, nees_high = 0;  ///< mean over the degrees of freedom, and its 95 % band around 1
  double lead_rms = 0;                           ///< of the slide, extrapolated by kLead [m]
  TimeSummary track, search;                     ///< [s]

  double boundRatio() const { return rms / bound; }
  bool consistent() const { return nees >= nees_low && nees <= nees_high; }
};

/// Collects runs of one method.
class Scorer {
 public:
  Scorer(const Method& method, const ScoreLimits& limits) : method_(&method), limits_(limits) {}
  void add(const BenchScene& scene, const std::vector<RenderedFrame>& frames, const MethodRun& run,
           const std::vector<MarkerBound>& bounds);
  Score score() const;

 private:
  void addFrame(const SyntheticTruth& truth, const Estimate& estimate, double scale);
  void addSearch(const SyntheticTruth& truth, const Estimate& estimate, double scale);
  void addConsistency(double error, double turn, const Estimate& estimate);

  const Method* method_;
  ScoreLimits limits_;
  Score sum_;
  double errors_ = 0, squares_ = 0, count_ = 0;
  double turn_squares_ = 0;
  double nees_sum_ = 0, nees_count_ = 0;
  double bound_squares_ = 0, bound_count_ = 0;
  double lead_squares_ = 0, lead_count_ = 0;
  std::vector<double> track_times_, search_times_;
};

}  // namespace vibe::vision::evidence
