#include "track/axis_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "track/arithmetic.hpp"

namespace vibe::vision {

AxisSamples::AxisSamples(std::size_t size)
    : values_(size + kSpare, 0), seen_(size + 1, 0), sum_(size + 1, 0), squares_(size + 1, 0) {}

void AxisSamples::set(std::size_t i, float value) {
  const bool seen = value >= 0;
  values_[i] = seen ? value : 0;
  seen_[i + 1] = seen_[i] + (seen ? 1 : 0);
  sum_[i + 1] = sum_[i] + values_[i];
  squares_[i + 1] = squares_[i] + static_cast<double>(values_[i]) * values_[i];
}

SearchTemplate::SearchTemplate(const MarkerPattern& pattern, double motion, double scale)
    : motion_(motion), scale_(scale) {
  pattern.searchProfile(motion, scale, profiles_[0]);
  pattern.searchTurns(motion, scale, profiles_[1], profiles_[2]);
  count_ = profiles_[1].empty() ? 1 : 3;
  half_ = static_cast<int>(profiles_[0].size() / 2);
  Eigen::Matrix3d products = Eigen::Matrix3d::Identity();
  for (int k = 0; k < count_; ++k) {
    std::vector<float>& p = profiles_[k];
    const float mean = std::accumulate(p.begin(), p.end(), 0.0F) / static_cast<float>(p.size());
    for (float& value : p) value -= mean;
    for (int j = 0; j <= k; ++j)
      products(j, k) = products(k, j) = std::inner_product(p.begin(), p.end(), profiles_[j].begin(), 0.0, std::plus<>(),
                                                           [](double a, double b) { return a * b; });
    p.resize((p.size() + kLanes - 1) / kLanes * kLanes, 0);
  }
  inverse_ = products.inverse();
}

namespace {

/// Products of values with each profile. @param size  of the profiles, a multiple of kLanes
VIBE_LANES void multiply(const float* values, const std::array<std::vector<float>, 3>& profiles, int count,
                         double* products) {
  const float *p = profiles[0].data(), *q = profiles[1].data(), *r = profiles[2].data();
  const std::size_t size = profiles[0].size();
  Eight sums[3] = {};
  for (std::size_t i = 0; i < size; i += kLanes) {
    const Eight value = *reinterpret_cast<const Eight*>(values + i);
    sums[0] += value * *reinterpret_cast<const Eight*>(p + i);
    if (count == 1) continue;
    sums[1] += value * *reinterpret_cast<const Eight*>(q + i);
    sums[2] += value * *reinterpret_cast<const Eight*>(r + i);
  }
  for (int k = 0; k < count; ++k) {
    const float* e = reinterpret_cast<const float*>(&sums[k]);
    products[k] = total(loadFour(e) + loadFour(e + kFourSize));
  }
}

constexpr double kMotionStep = 4;  // between templates [px]
constexpr int kMotions = 9;
constexpr double kFirstMotion = 1;  // [px]
constexpr double kScales[] = {0.93, 1, 1.075};
constexpr double kMinCorrelation = 0.4;     // of a candidate,
constexpr double kLeastCorrelation = 0.25;  // of a place beside one
constexpr double kMaxTurn = 1.7;  // what the rotation adds, relative to what it can add: noise and other things
constexpr int kMinDistance = 4;   // between candidates [px]

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

SearchTemplate::Match SearchTemplate::match(const AxisSamples& samples, std::size_t place, double least) const {
  const std::size_t begin = place - static_cast<std::size_t>(half_), end = place + static_cast<std::size_t>(half_) + 1;
  const double n = 2 * half_ + 1;
  if (samples.seen(begin, end) < 2 * half_ + 1) return matchPart(samples, begin, least);
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  multiply(samples.data() + begin, profiles_, count_, products.data());
  const double sum = samples.sum(begin, end);
  const Eigen::Vector3d parts = inverse_ * products;
  return describe(parts, parts.dot(products), samples.squares(begin, end) - sum * sum / n, least);
}

SearchTemplate::Match SearchTemplate::matchPart(const AxisSamples& samples, std::size_t begin, double least) const {
  const std::size_t size = 2 * static_cast<std::size_t>(half_) + 1;
  if (2 * samples.seen(begin, begin + size) < static_cast<int>(size)) return {};
  Eigen::Matrix4d gram = Eigen::Matrix4d::Zero();
  Eigen::Vector4d products = Eigen::Vector4d::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (!samples.isSeen(begin + i)) continue;
    const double f = samples.data()[begin + i];
    Eigen::Vector4d p(profiles_[0][i], 0, 0, 1);
    if (count_ > 1) p[1] = profiles_[1][i], p[2] = profiles_[2][i];
    gram += p * p.transpose();
    products += f * p;
    squares += f * f;
  }
  const double n = gram(3, 3), sum = products[3];
  gram.diagonal().array() += 1e-6 * n;
  const Eigen::Vector4d parts = gram.ldlt().solve(products);
  return describe(parts.head<3>(), parts.dot(products) - sum * sum / n, squares - sum * sum / n, least);
}

SearchTemplate::Match SearchTemplate::describe(const Eigen::Vector3d& parts, double explained, double spread,
                                               double least) const {
  Match match;
  match.contrast = parts[0];
  if (spread <= 0 || explained <= least * least * spread || parts[0] <= 0) return match;
  match.correlation = std::sqrt(std::min(1.0, explained / spread));
  match.turn = std::hypot(parts[1], parts[2]) / parts[0];
  match.rotation = std::atan2(parts[2], parts[1]);
  return match;
}

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
  for (int i = from; i < to; i += 2) best_[i] = bestAt(static_cast<std::size_t>(i), max_motion, min_contrast);
  for (int i = from + 1; i < to; i += 2) {  // only between places that look a little like it
    const double around = std::max(best_[i - 1].score, i + 1 < to ? best_[i + 1].score : 0);
    best_[i] = around > 0 ? bestAt(static_cast<std::size_t>(i), max_motion, min_contrast) : Candidate();
  }
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
    const SearchTemplate::Match match = t.match(samples_, place, std::max(best.score, kLeastCorrelation));
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
