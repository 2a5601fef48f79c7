#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "bench/bench_scene.hpp"
#include "vibe_vision/track/tracker_policy.hpp"

namespace vibe::vision::evidence {

/// How well a tracker knows when it is wrong: of one marker in one scene. Wrong is a report of a hidden marker, or one
/// that is off by more than 0.5 mm, 3 degrees or five stated deviations.
struct DoubtRow {
  std::string scene;
  bool sleeve = false;
  int frames = 0, reports = 0;
  int wrong = 0, silent = 0;  ///< silent: of the wrong ones, those without a doubt
  int needless = 0;           ///< right, but with another doubt than `unchecked`

  void add(const BenchScene& bench, const std::vector<RenderedFrame>& drawn, const TrackerPolicy& policy = {});
};

/// The standard scenes and those with faults, each seed from its first frame on.
/// @param scenes  empty: all
std::vector<DoubtRow> doubtTable(const std::vector<std::string>& scenes, const std::vector<std::uint64_t>& seeds,
                                 int frames);
/// Markdown.
void writeDoubts(std::ostream& out, const std::vector<DoubtRow>& rows);

}  // namespace vibe::vision::evidence
