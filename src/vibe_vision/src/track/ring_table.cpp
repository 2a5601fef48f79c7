#include "track/ring_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

constexpr double kBlurRatio = 1.25;        // of the blur from one level to the next
constexpr double kPerBlur = 9;             // values of the radial profile per standard deviation
constexpr double kGaussTail = 6.5;         // standard deviations of a Gaussian that count
constexpr double kReach = 4.5, kRoom = 2;  // standard deviations and pixels beyond which all is white
constexpr double kMinRingMotion = 0.05;    // below it the picture is that of 0.05 px [px]
constexpr float kPole = -0.26794919F;      // of the cubic B-spline: sqrt(3) - 2

double gauss(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2 * M_PI);
}
double cumulative(double x) {
  return 0.5 * std::erfc(-x / M_SQRT2);
}

/// Gaussian blur of a disc at distance r from its centre: sum over its chords v = radius sin(angle).
double blurredDisc(double r, double radius, double blur) {
  if (r < radius - kGaussTail * blur) return 1;
  if (r > radius + kGaussTail * blur) return 0;
  constexpr int kIntervals = 96;  // of Simpson's rule
  const double limit = std::asin(std::min(1.0, kGaussTail * blur / radius));
  double sum = 0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double angle = limit * i / kIntervals;
    const double v = radius * std::sin(angle), half = radius * std::cos(angle);
    const double weight = i == 0 || i == kIntervals ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * half * gauss(v / blur) / blur * (cumulative((r + half) / blur) - cumulative((r - half) / blur));
  }
  return 2 * sum * limit / (3 * kIntervals);
}

/// Cubic Lagrange interpolation in a table that begins at 0 and is even there.
double lookUp(const std::vector<double>& table, double place) {
  const auto i =
      std::clamp(static_cast<std::ptrdiff_t>(place), std::ptrdiff_t{1}, static_cast<std::ptrdiff_t>(table.size()) - 3);
  const double f = place - static_cast<double>(i);
  const double* p = table.data() + i;
  return p[0] * (f + 1) * (f - 1) * (f - 2) / 2 - p[1] * (f + 1) * f * (f - 2) / 2 - p[-1] * f * (f - 1) * (f - 2) / 6 +
         p[2] * (f + 1) * f * (f - 1) / 6;
}

/// Samples -> coefficients of a cubic B-spline along one dimension, `width` series side by side. Before the first
/// sample the series continues as its mirror image times `parity`; after the last it stays as it is.
template <class Row>
void prefilter(const Row& row, int count, int width, float parity) {
  constexpr int kTerms = 14;  // of the geometric series: 1e-8
  for (int j = 0; j < width; ++j) {
    float sum = row(0)[j], power = 1;
    for (int k = 1; k < std::min(kTerms, count); ++k) {
      power *= kPole;
      sum += parity * power * row(k)[j];
    }
    row(0)[j] = 6 * sum;
  }
  for (int i = 1; i < count; ++i) {
    const float* before = row(i - 1);
    float* here = row(i);
    for (int j = 0; j < width; ++j) here[j] = 6 * here[j] + kPole * before[j];
  }
  for (int j = 0; j < width; ++j) row(count - 1)[j] *= -kPole / (1 - kPole);
  for (int i = count - 2; i >= 0; --i) {
    const float* after = row(i + 1);
    float* here = row(i);
    for (int j = 0; j < width; ++j) here[j] = kPole * (after[j] - here[j]);
  }
}

int stepsFor(double reach) {
  return static_cast<int>(std::ceil(reach / RingTable::kStep)) + 4;
}
int rowsFor(double reach) {
  return stepsFor(reach) + RingTable::kMargin;
}
int columnsFor(double reach) {
  return (rowsFor(reach) + 3) / 4 * 4;
}

/// Weights of the cubic B-spline at a fraction f between the second and the third of four coefficients.
std::array<float, 4> splineWeights(double f) {
  const double g = 1 - f;
  return {static_cast<float>(g * g * g / 6), static_cast<float>(2.0 / 3 - f * f * (2 - f) / 2),
          static_cast<float>(2.0 / 3 - g * g * (2 - g) / 2), static_cast<float>(f * f * f / 6)};
}

}  // namespace

RingTable::RingTable(double inner, double outer, double reach_u, double reach_v, double max_motion)
    : inner_(inner), outer_(outer), max_motion_(max_motion) {
  rows_ = rowsFor(reach_u);
  columns_ = columnsFor(reach_v);
  integral_rows_ = rows_ + stepsFor(max_motion / 2) + 10;  // the filter needs some to settle
  for (double blur = kMinBlur; blur < kMaxBlur * kBlurRatio; blur *= kBlurRatio) levels_.push_back({blur, {}});
  for (Level& level : levels_) buildLevel(level);
  mixed_.resize(static_cast<std::size_t>(integral_rows_) * columns_);
  table_.resize(static_cast<std::size_t>(rows_) * columns_);
}

std::vector<double> RingTable::radialProfile(double blur) const {
  const double reach = std::hypot(integral_rows_, columns_) * kStep;
  std::vector<double> profile(static_cast<std::size_t>(reach * kPerBlur / blur) + 4);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double r = static_cast<double>(i) * blur / kPerBlur;
    profile[i] = 1 - blurredDisc(r, outer_, blur) + blurredDisc(r, inner_, blur);
  }
  return profile;
}

void RingTable::buildLevel(Level& level) const {
  constexpr int kParts = 4;  // of a step, for Simpson's rule
  const std::vector<double> profile = radialProfile(level.blur);
  level.integral.resize(static_cast<std::size_t>(integral_rows_) * columns_);
  for (int j = 0; j < columns_; ++j) {
    const double v = (j - kMargin) * kStep;
    const auto value = [&](double u) { return lookUp(profile, std::sqrt(u * u + v * v) * kPerBlur / level.blur); };
    double sum = 0, last = value(0);
    for (int i = 0; i < integral_rows_; ++i) {
      level.integral[static_cast<std::size_t>(i) * columns_ + j] = static_cast<float>(sum);
      const double h = kStep / kParts, u = i * kStep;
      for (int k = 0; k < kParts; ++k) {
        const double next = value(u + (k + 1) * h);
        sum += h / 6 * (last + 4 * value(u + (k + 0.5) * h) + next);
        last = next;
      }
    }
  }
  prefilterIntegral(level.integral);
}

void RingTable::prefilterIntegral(std::vector<float>& integral) const {
  prefilter([&](int i) { return integral.data() + static_cast<std::ptrdiff_t>(i) * columns_; }, integral_rows_,
            columns_, -1);
  for (int i = 0; i < integral_rows_; ++i) {
    float* row = integral.data() + static_cast<std::ptrdiff_t>(i) * columns_ + kMargin;
    prefilter([&](int j) { return row + j; }, columns_ - kMargin, 1, 1);
    for (int j = 1; j <= kMargin; ++j) row[-j] = row[j];
  }
}

void RingTable::compose(double blur, double motion) {
  blur_ = std::clamp(blur, kMinBlur, kMaxBlur);
  motion_ = std::clamp(std::abs(motion), kMinRingMotion, max_motion_);
  const double reach = outer_ + kReach * blur_ + kRoom;
  used_rows_ = std::min(rows_, rowsFor(reach + motion_ / 2));
  used_columns_ = std::min(columns_, columnsFor(reach));
  mixLevels(std::min(integral_rows_, used_rows_ + stepsFor(motion_ / 2)));
  spreadMotion();
  prefilter([&](int i) { return table_.data() + static_cast<std::ptrdiff_t>(i + kMargin) * columns_; },
            used_rows_ - kMargin, used_columns_, 1);
  for (int i = 1; i <= kMargin; ++i)
    std::copy_n(row(kMargin + i), used_columns_, table_.data() + static_cast<std::ptrdiff_t>(kMargin - i) * columns_);
}

/// Quadratic interpolation in the logarithm of the blur.
VIBE_LANES void RingTable::mixLevels(int rows) {
  const double place = std::log(blur_ / kMinBlur) / std::log(kBlurRatio);
  const auto last = static_cast<std::ptrdiff_t>(levels_.size()) - 2;
  const auto middle = std::clamp(static_cast<std::ptrdiff_t>(std::lround(place)), std::ptrdiff_t{1}, last);
  const double f = place - static_cast<double>(middle);
  const auto a = static_cast<float>(f * (f - 1) / 2), b = static_cast<float>(1 - f * f),
             c = static_cast<float>(f * (f + 1) / 2);
  const float* p = levels_[middle - 1].integral.data();
  const float* q = levels_[middle].integral.data();
  const float* r = levels_[middle + 1].integral.data();
  const int columns = used_columns_ / 4 * 4;
  for (int row = 0; row < rows; ++row, p += columns_, q += columns_, r += columns_) {
    float* __restrict out = mixed_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
    for (int j = 0; j < columns; ++j) out[j] = a * p[j] + b * q[j] + c * r[j];
  }
}

/// Samples of the mean over the motion at the rows' places: difference of the integral at its two ends.
VIBE_LANES void RingTable::spreadMotion() {
  const double shift = motion_ / 2 / kStep;
  const int whole = static_cast<int>(shift), columns = used_columns_ / 4 * 4;
  const std::array<float, 4> w = splineWeights(shift - whole);
  const auto scale = static_cast<float>(1 / motion_);
  for (int i = 0; i < used_rows_ - kMargin; ++i) {
    float* __restrict out = table_.data() + static_cast<std::ptrdiff_t>(i + kMargin) * columns_;
    const float* rows[8];
    float weights[8];
    for (int k = 0; k < 8; ++k) {
      const int row = k < 4 ? i + whole + k - 1 : i - whole - k + 5;
      const float weight = scale * (k < 4 ? w[k] : -w[k - 4]);
      rows[k] = mixed_.data() + static_cast<std::ptrdiff_t>(std::abs(row)) * columns_;
      weights[k] = row < 0 ? -weight : weight;  // the integral is odd
    }
    for (int j = 0; j < columns; ++j)
      out[j] =
          ((rows[0][j] * weights[0] + rows[1][j] * weights[1]) + (rows[2][j] * weights[2] + rows[3][j] * weights[3])) +
          ((rows[4][j] * weights[4] + rows[5][j] * weights[5]) + (rows[6][j] * weights[6] + rows[7][j] * weights[7]));
  }
}

}  // namespace vibe::vision
