#include "vibe_core/trainee/skill.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace vibe::tremor_test {
namespace {

constexpr double kRate = 100;  // samples per second: far above twice the band
constexpr int kSamples = 20000;
constexpr int kShortSamples = 2000;  // 20 s: spectral lines as wide as the grid below

TremorSettings settings() {
  TremorSettings result;
  result.amplitude[Insertion] = 1e-4;
  result.amplitude[TipUpDown] = 2e-3;
  return result;
}

std::vector<double> sampled(const Tremor& tremor, int joint) {
  std::vector<double> values;
  for (int k = 0; k < kSamples; ++k) values.push_back(tremor.at(joint, k / kRate));
  return values;
}

double rootMeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Share of the power between two frequencies, by a Hann-windowed Fourier sum on a grid of 1/20 Hz.
double powerShare(const std::vector<double>& values, double low, double high) {
  double inside = 0, all = 0;
  for (int bin = 0; bin < static_cast<int>(kRate / 2 * 20); ++bin) {
    const double frequency = bin / 20.0;
    std::complex<double> sum = 0;
    const std::complex<double> turn = std::polar(1.0, -2 * M_PI * frequency / kRate);
    std::complex<double> phase = 1;
    for (int k = 0; k < kShortSamples; ++k) {
      sum += values[k] * (0.5 - 0.5 * std::cos(2 * M_PI * k / kShortSamples)) * phase;
      phase *= turn;
    }
    all += std::norm(sum);
    if (frequency >= low && frequency <= high) inside += std::norm(sum);
  }
  return inside / all;
}

TEST(Tremor, HasTheAskedSize) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Tremor tremor(settings(), seed);
    EXPECT_NEAR(rootMeanSquare(sampled(tremor, Insertion)), 1e-4, 2e-6) << seed;
    EXPECT_NEAR(rootMeanSquare(sampled(tremor, TipUpDown)), 2e-3, 4e-5) << seed;
    EXPECT_EQ(rootMeanSquare(sampled(tremor, Rotation)), 0) << seed;
  }
}

TEST(Tremor, LiesInItsBand) {
  const std::vector<double> values = sampled(Tremor(settings(), 5), TipUpDown);
  EXPECT_GT(powerShare(values, 7.9, 12.1), 0.999);
  EXPECT_LT(powerShare(values, 0, 7.9), 1e-3);
  TremorSettings slow = settings();
  slow.low_frequency = 1;
  slow.high_frequency = 3;
  EXPECT_LT(powerShare(sampled(Tremor(slow, 5), TipUpDown), 7.9, 12.1), 1e-3);  // the measure can tell
}

TEST(Tremor, FillsItsBand) {
  const std::vector<double> values = sampled(Tremor(settings(), 5), TipUpDown);
  for (double low = 8; low < 11.5; low += 2.0) EXPECT_GT(powerShare(values, low, low + 2), 0.3) << low;
}

TEST(Tremor, ScaleMultiplies) {
  TremorSettings strong = settings();
  strong.scale = 3;
  for (double t = 0; t < 1; t += 0.013) {
    EXPECT_NEAR(Tremor(strong, 4).at(Insertion, t), 3 * Tremor(settings(), 4).at(Insertion, t), 1e-17);
  }
  strong.scale = 0;
  EXPECT_EQ(Tremor(strong, 4).at(Insertion, 0.3), 0);
}

TEST(Tremor, FollowsItsSeedOnly) {
  EXPECT_EQ(Tremor(settings(), 4).at(Insertion, 12.34), Tremor(settings(), 4).at(Insertion, 12.34));
  EXPECT_NE(Tremor(settings(), 4).at(Insertion, 12.34), Tremor(settings(), 5).at(Insertion, 12.34));
  TremorSettings one_joint = settings();
  one_joint.amplitude[Insertion] = 0;  // another joint's tremor stays the same
  EXPECT_EQ(Tremor(one_joint, 4).at(TipUpDown, 1.5), Tremor(settings(), 4).at(TipUpDown, 1.5));
}

TEST(Tremor, NoneByDefault) {
  EXPECT_EQ(Tremor().at(Insertion, 1.0), 0);
  EXPECT_EQ(Tremor(TremorSettings{}, 1).at(Insertion, 1.0), 0);
}

}  // namespace
}  // namespace vibe::tremor_test
