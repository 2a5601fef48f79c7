#include "calibrate/student_t.hpp"

#include <cmath>

namespace vibe {

// With t = sqrt(n) tan(a) the density becomes cos^(n - 1)(a), up to a constant.
double studentTail(double t, int freedom) {
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
  return integral(angle, M_PI / 2) / integral(0, M_PI / 2);
}

}  // namespace vibe
