#include "calibrate/student_t.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {

// With t = sqrt(n) tan(a) the density becomes cos^(n - 1)(a), up to a constant.
double studentTail(double t, int freedom) {
  const double reach = std::min(M_PI / 2, 9 / std::sqrt(freedom));  // beyond, nothing is left
  const auto integral = [freedom](double from, double to) {
    constexpr int kSteps = 400;  // even: Simpson
    const double h = (to - from) / kSteps;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double weight = i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2);
      sum += weight * std::pow(std::cos(from + i * h), freedom - 1);
    }
    return sum * h / 3;
  };
  const double angle = std::atan(std::abs(t) / std::sqrt(freedom));
  return angle < reach ? integral(angle, reach) / integral(0, reach) : 0;
}

double studentQuantile(double tail, int freedom) {
  double low = 0, high = 1;
  while (studentTail(high, freedom) > tail && high < 1e9) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (studentTail(middle, freedom) > tail ? low : high) = middle;
  }
  return high;
}

}  // namespace vibe::vision
