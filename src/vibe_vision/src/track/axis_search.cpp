#include "track/axis_search.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {
namespace {

constexpr double kMotionStep = 4;  // between templates [px]
constexpr int kMotions = 9;
constexpr double kFirstMotion = 1;  // [px]
constexpr double kScales[] = {0.93, 1, 1.075};
constexpr double kMinCorrelation = 0.4;  // of a candidate
constexpr double kMaxTurn = 1.7;         // what the rotation adds, relative to what it can add: noise and other things
constexpr int kMinDistance = 4;          // between candidates [px]

std::vector<SearchTemplate> makeTemplates(const MarkerPattern& pattern) {
  std::vector<SearchTemplate> templates;
  for (int i = 0; i < kMotions; ++i)
    for (double scale : kScales) templates.emplace_back(pattern, kFirstMotion + i * kMotionStep, scale);
  return templates;
}

int reachOf(const std::vector<SearchTemplate>& templates) {
  int reach = 0;
  for (const SearchTemplate& t : templates) reach = std::max(reach, t.half());
  return reach;
}

}  // namespace

AxisSearch::AxisSearch(const MarkerPattern& pattern, double begin, double end)
    : begin_(begin),
      end_(end),
      half_width_(pattern.searchHalfWidth()),
      templates_(makeTemplates(pattern)),
      samples_(static_cast<std::size_t>(std::ceil(end - begin)) + 2 * static_cast<std::size_t>(reachOf(templates_)) +
               8) {
  reach_ = reachOf(templates_);
  first_ = std::floor(begin) - reach_ - 1;
  band_.sum.resize(samples_.size());
  band_.count.resize(samples_.size());
  best_.resize(samples_.size());
}

const AxisSearch::Result& AxisSearch::run(const AxisMap& map, const Frame& frame, double begin, double end,
                                          double max_motion, double min_contrast) {
  result_ = {};
  readBand(map, frame, begin - reach_, end + reach_);
  const auto bins = static_cast<int>(samples_.size());
  const int from = std::clamp(static_cast<int>(std::floor(begin - first_)), reach_, bins - reach_);
  const int to = std::clamp(static_cast<int>(std::ceil(end - first_)) + 1, from, bins - reach_);
  for (int i = from; i < to; ++i) best_[i] = bestAt(static_cast<std::size_t>(i), max_motion, min_contrast);
  for (int i = from; i < to; ++i) {
    const bool peak =
        (i == from || best_[i].score > best_[i - 1].score) && (i + 1 == to || best_[i].score >= best_[i + 1].score);
    if (peak && best_[i].score >= kMinCorrelation) keep(best_[i]);
  }
  return result_;
}

void AxisSearch::readBand(const AxisMap& map, const Frame& frame, double begin, double end) {
  band_.first = first_;
  map.readBand(frame, begin, end, half_width_, band_);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const float mean = band_.count[i] > 0 ? band_.sum[i] / band_.count[i] : -1;
    samples_.set(i, mean);
    if (mean < 0) continue;
    result_.in_view = true;
    result_.darkest = std::min<double>(result_.darkest, mean);
    result_.brightest = std::max<double>(result_.brightest, mean);
  }
  result_.saturated = band_.pixels > 0 ? static_cast<double>(band_.saturated) / band_.pixels : 0;
}

AxisSearch::Candidate AxisSearch::bestAt(std::size_t place, double max_motion, double min_contrast) const {
  Candidate best;
  best.along = first_ + static_cast<double>(place);
  for (const SearchTemplate& t : templates_) {
    if (t.motion() > max_motion + kMotionStep) break;
    const SearchTemplate::Match match = t.match(samples_, place);
    if (match.correlation <= best.score || match.contrast < 0.4 * min_contrast || match.turn > kMaxTurn) continue;
    best.score = match.correlation, best.motion = t.motion(), best.scale = t.scale();
    best.rotation = match.rotation, best.shows_rotation = match.turn > 0;
  }
  return best;
}

void AxisSearch::keep(const Candidate& candidate) {
  Candidate next = candidate;
  for (int i = 0; i < result_.count; ++i) {  // one of two neighbours stays
    Candidate& other = result_.candidates[i];
    if (std::abs(other.along - next.along) >= kMinDistance) continue;
    if (other.score >= next.score) return;
    for (int k = i; k + 1 < result_.count; ++k) result_.candidates[k] = result_.candidates[k + 1];
    --result_.count;
    break;
  }
  for (int i = 0; i < kCandidates; ++i) {
    if (i < result_.count && result_.candidates[i].score >= next.score) continue;
    std::swap(result_.candidates[i], next);
    if (i >= result_.count) {
      ++result_.count;
      return;
    }
  }
}

}  // namespace vibe::vision
