#include "statistics.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace vibe::hardware {

void SequenceCount::add(std::uint16_t sequence) {
  const auto step = static_cast<std::uint16_t>(sequence - last_);
  last_ = sequence;
  if (received++ == 0) return;
  if (step == 0) {
    ++repeated;
  } else if (step < 0x8000) {
    lost += step - 1;
  } else {
    ++reordered;
  }
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void figure(const std::string& name, double value, const std::string& unit) {
  std::printf("figure %s: %.3g %s\n", name.c_str(), value, unit.c_str());
  std::fflush(stdout);
}

void figures(const std::string& name, const std::vector<double>& times) {
  if (times.empty()) return;
  const double n = static_cast<double>(times.size());
  const double mean = std::accumulate(times.begin(), times.end(), 0.0) / n;
  double squares = 0;
  for (const double time : times) squares += (time - mean) * (time - mean);
  figure(name + ", mean", 1000 * mean, "ms");
  figure(name + ", standard deviation", 1000 * std::sqrt(squares / n), "ms");
  figure(name + ", largest", 1000 * *std::max_element(times.begin(), times.end()), "ms");
}

std::vector<double> differences(const std::vector<double>& values) {
  std::vector<double> result(values.size());
  std::adjacent_difference(values.begin(), values.end(), result.begin());
  if (!result.empty()) result.erase(result.begin());
  return result;
}

}  // namespace vibe::hardware
