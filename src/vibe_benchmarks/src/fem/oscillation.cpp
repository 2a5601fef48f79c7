#include "fem/oscillation.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::benchmarks {

Oscillation measureOscillation(const std::vector<double>& values, double step) {
  std::vector<double> crossings;  // upwards, in steps
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i - 1] < 0 && values[i] >= 0)
      crossings.push_back(static_cast<double>(i - 1) + values[i - 1] / (values[i - 1] - values[i]));
  Oscillation found{std::nan(""), std::nan("")};
  if (crossings.size() < 2) return found;
  const auto periods = static_cast<double>(crossings.size() - 1);
  found.frequency = periods / ((crossings.back() - crossings.front()) * step);
  // half the range of each period, which is independent of an offset
  std::vector<double> amplitude;
  for (std::size_t p = 0; p + 1 < crossings.size(); ++p) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(crossings[p]);
    const auto last = values.begin() + static_cast<std::ptrdiff_t>(crossings[p + 1]) + 1;
    amplitude.push_back(*std::max_element(first, last) - *std::min_element(first, last));
  }
  if (amplitude.size() > 1)
    found.kept = std::pow(amplitude.back() / amplitude.front(), 1 / static_cast<double>(amplitude.size() - 1));
  return found;
}

}  // namespace vibe::benchmarks
