#include "track/normal_table.hpp"

#include <cmath>

namespace vibe::vision {

NormalTable::NormalTable() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const double x = static_cast<double>(i) / kPerUnit - kReach;
    const double value = 0.5 * std::erfc(-x * M_SQRT1_2), density = std::exp(-x * x / 2) / std::sqrt(2 * M_PI);
    entries_[i] = {static_cast<float>(x * value + density), static_cast<float>(value), static_cast<float>(density)};
  }
}

const NormalTable& NormalTable::instance() {
  static const NormalTable table;
  return table;
}

}  // namespace vibe::vision
