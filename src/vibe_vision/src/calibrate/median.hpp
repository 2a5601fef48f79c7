#pragma once
#include <algorithm>
#include <vector>

namespace vibe::vision {

/// Of two in the middle the greater. There must be a value.
template <class Number>
Number median(std::vector<Number> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace vibe::vision
