#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::hardware {

/// Counts what is wrong in a row of sequence numbers of 16 bits.
struct SequenceCount {
  int received = 0, lost = 0, repeated = 0, reordered = 0;

  void add(std::uint16_t sequence);

 private:
  std::uint16_t last_ = 0;
};

/// Time on the guest's clock [s].
double now();

/// Prints a line for scripts/hid_kernel: a measured value with its unit.
void figure(const std::string& name, double value, const std::string& unit);

/// Prints mean, standard deviation and largest value [ms] of times [s].
void figures(const std::string& name, const std::vector<double>& times);

/// Differences of neighbours.
std::vector<double> differences(const std::vector<double>& values);

}  // namespace vibe::hardware
