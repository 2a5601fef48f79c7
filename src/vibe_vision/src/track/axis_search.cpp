#include "track/axis_search.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

constexpr double kMotionStep = 4;        // between profiles [px]
constexpr int kMotions = 13;             // profiles
constexpr double kMinCorrelation = 0.4;  // of a candidate
constexpr double kMinSeen = 0.5;         // share of a profile's bins that must be seen
constexpr int kMinDistance = 4;          // between candidates [px]

}  // namespace

AxisSearch::AxisSearch(const MarkerPattern& pattern, double begin, double end)
    : half_width_(pattern.searchHalfWidth()), profiles_(kMotions) {
  for (int i = 0; i < kMotions; ++i) {
    pattern.searchProfile(i * kMotionStep, profiles_[i]);
    reach_ = std::max(reach_, static_cast<int>(profiles_[i].size() / 2));
  }
  first_ = std::floor(begin) - reach_;
  const auto bins = static_cast<std::size_t>(std::ceil(end - first_) + reach_ + 2);
  band_.sum.resize(bins);
  band_.count.resize(bins);
  mean_.resize(bins);
  scores_.resize(bins);
}

const AxisSearch::Result& AxisSearch::run(const AxisMap& map, const Frame& frame, double begin, double end,
                                          double max_motion, double min_contrast) {
  result_ = {};
  readBand(map, frame, begin - reach_, end + reach_);
  const int bins = static_cast<int>(mean_.size());
  const int from = std::clamp(static_cast<int>(std::floor(begin - first_)), 0, bins);
  const int to = std::clamp(static_cast<int>(std::ceil(end - first_)) + 1, from, bins);
  const int motions = std::clamp(static_cast<int>(std::ceil(max_motion / kMotionStep)) + 1, 1, kMotions);
  for (int i = from; i < to; ++i) {
    scores_[i] = {};
    for (int k = 0; k < motions; ++k) {
      const double c = correlate(profiles_[k], i, min_contrast);
      if (c > scores_[i].correlation) scores_[i] = {c, k};
    }
  }
  for (int i = from; i < to; ++i) {
    const bool peak = (i == from || scores_[i].correlation > scores_[i - 1].correlation) &&
                      (i + 1 == to || scores_[i].correlation >= scores_[i + 1].correlation);
    if (peak && scores_[i].correlation >= kMinCorrelation) keep(i, scores_[i]);
  }
  return result_;
}

void AxisSearch::readBand(const AxisMap& map, const Frame& frame, double begin, double end) {
  band_.first = first_;
  map.readBand(frame, begin, end, half_width_, band_);
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    mean_[i] = band_.count[i] > 0 ? band_.sum[i] / band_.count[i] : -1;
    if (band_.count[i] <= 0) continue;
    result_.in_view = true;
    result_.darkest = std::min<double>(result_.darkest, mean_[i]);
    result_.brightest = std::max<double>(result_.brightest, mean_[i]);
  }
  result_.saturated = band_.pixels > 0 ? static_cast<double>(band_.saturated) / band_.pixels : 0;
}

/// Correlation coefficient of the seen bins; 0 if there is too little contrast or it has the wrong sign.
double AxisSearch::correlate(const std::vector<float>& profile, int place, double min_contrast) const {
  const int half = static_cast<int>(profile.size() / 2), bins = static_cast<int>(mean_.size());
  float n = 0, f = 0, t = 0, ff = 0, tt = 0, ft = 0;
  for (int i = std::max(-half, -place); i <= std::min(half, bins - 1 - place); ++i) {
    const float a = mean_[place + i], b = profile[static_cast<std::size_t>(i + half)];
    if (a < 0) continue;
    n += 1, f += a, t += b, ff += a * a, tt += b * b, ft += a * b;
  }
  if (n < kMinSeen * static_cast<double>(profile.size())) return 0;
  const double spread = static_cast<double>(ff) - static_cast<double>(f) * f / n;
  const double shape = static_cast<double>(tt) - static_cast<double>(t) * t / n;
  const double common = static_cast<double>(ft) - static_cast<double>(f) * t / n;
  if (spread <= 0 || shape <= 0 || common < 0.4 * min_contrast * shape) return 0;
  return common / std::sqrt(spread * shape);
}

void AxisSearch::keep(int place, const Score& score) {
  Candidate next{first_ + place, score.motion * kMotionStep, score.correlation};
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

}  // namespace vibe
