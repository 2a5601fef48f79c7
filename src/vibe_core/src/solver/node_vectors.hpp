#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace vibe {

// Vectors over the nodes in single precision, 4 numbers per node.

/// Two nodes at once: eight sums in double precision, added up in a fixed order.
inline double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  const std::size_t even = a.size() / 8 * 8;
  for (std::size_t i = 0; i < even; i += 8)
    for (std::size_t k = 0; k < 8; ++k) sum[k] += static_cast<double>(a[i + k]) * static_cast<double>(b[i + k]);
  for (std::size_t i = even; i < a.size(); ++i) sum[i - even] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

/// to += scale * a
inline void addMultiple(double scale, const std::vector<float>& a, std::vector<float>& to) {
  const auto s = static_cast<float>(scale);
  for (std::size_t i = 0; i < a.size(); ++i) to[i] += s * a[i];
}

/// Length of the longest vector of a node.
inline double largest(const std::vector<float>& a) {
  float max = 0;
  for (std::size_t i = 0; i < a.size(); i += 4)
    max = std::max(max, a[i] * a[i] + a[i + 1] * a[i + 1] + a[i + 2] * a[i + 2]);
  return std::sqrt(static_cast<double>(max));
}

}  // namespace vibe
