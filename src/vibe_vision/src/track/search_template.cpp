#include "track/search_template.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "track/float_sums.hpp"

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
    p.resize((p.size() + kFourSize - 1) / kFourSize * kFourSize, 0);
  }
  inverse_ = products.inverse();
}

SearchTemplate::Match SearchTemplate::match(const AxisSamples& samples, std::size_t place) const {
  const std::size_t begin = place - static_cast<std::size_t>(half_), end = place + static_cast<std::size_t>(half_) + 1;
  const double n = 2 * half_ + 1;
  if (samples.seen(begin, end) < 2 * half_ + 1) return matchPart(samples, begin);
  Four sums[3] = {};
  const float* f = samples.data() + begin;
  for (std::size_t i = 0; i < profiles_[0].size(); i += kFourSize) {
    const Four value = loadFour(f + i);
    sums[0] += value * loadFour(profiles_[0].data() + i);
    if (count_ == 1) continue;
    sums[1] += value * loadFour(profiles_[1].data() + i);
    sums[2] += value * loadFour(profiles_[2].data() + i);
  }
  const Eigen::Vector3d products(total(sums[0]), total(sums[1]), total(sums[2]));
  const double sum = samples.sum(begin, end);
  const Eigen::Vector3d parts = inverse_ * products;
  return describe(parts, parts.dot(products), samples.squares(begin, end) - sum * sum / n);
}

SearchTemplate::Match SearchTemplate::matchPart(const AxisSamples& samples, std::size_t begin) const {
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
  return describe(parts.head<3>(), parts.dot(products) - sum * sum / n, squares - sum * sum / n);
}

SearchTemplate::Match SearchTemplate::describe(const Eigen::Vector3d& parts, double explained, double spread) const {
  Match match;
  match.contrast = parts[0];
  if (spread <= 0 || explained <= 0 || parts[0] <= 0) return match;
  match.correlation = std::sqrt(std::min(1.0, explained / spread));
  match.turn = std::hypot(parts[1], parts[2]) / parts[0];
  match.rotation = std::atan2(parts[2], parts[1]);
  return match;
}

}  // namespace vibe::vision
