#include <algorithm>
#include <cmath>

#include "track/sleeve_pattern.hpp"

namespace vibe::vision {
namespace {

constexpr double kSearchRim = 0.6;       // of the radius: rows that show nearly the same
constexpr double kMeanCosine = 0.938;    // of the angle around the rod over these rows
constexpr float kSearchVariance = 0.5F;  // of the blur [px^2]
constexpr int kGuesses = 8;

/// Half length of the profile: white ends are left out as far as the motion mixes them with what is behind.
std::ptrdiff_t stepsOf(double half_length, double motion, double scale) {
  return static_cast<std::ptrdiff_t>(std::max(half_length * scale - 1 - motion / 2, 0.3 * half_length));
}

/// Part of u - half to u + half that lies between two places.
float overlap(float u, float half, float begin, float end) {
  return std::clamp(std::min(u + half, end) - std::max(u - half, begin), 0.0F, 2 * half) / (2 * half);
}

}  // namespace

double SleevePattern::searchHalfWidth() const {
  return kSearchRim * radius_;
}

void SleevePattern::searchProfile(double motion, double scale, std::vector<float>& profile) const {
  const std::ptrdiff_t steps = stepsOf(half_length_, motion, scale);
  const auto half = static_cast<float>(std::max(motion, 1.0) / 2 / scale);
  profile.clear();
  for (std::ptrdiff_t k = -steps; k <= steps; ++k) {
    const auto u = static_cast<float>(static_cast<double>(k) / scale);
    const float bars = bars_.at(u + half, kSearchVariance).integral - bars_.at(u - half, kSearchVariance).integral;
    profile.push_back(1 - bars / (2 * half) - stripe_.mean() * overlap(u, half, helix_begin_, helix_end_));
  }
}

/// The first harmonic of the stripe. Its mean over the rows is smaller, and the motion makes it smaller still.
void SleevePattern::searchTurns(double motion, double scale, std::vector<float>& cosine,
                                std::vector<float>& sine) const {
  const std::ptrdiff_t steps = stepsOf(half_length_, motion, scale);
  const double half = std::max(motion, 1.0) / 2 / scale, travel = 2 * M_PI * half / std::abs(pitch_);
  const double size = 2 / M_PI * std::sin(M_PI * stripe_.mean()) * kMeanCosine * std::sin(travel) / travel;
  cosine.clear();
  sine.clear();
  for (std::ptrdiff_t k = -steps; k <= steps; ++k) {
    const double u = static_cast<double>(k) / scale, turn = 2 * M_PI * u / pitch_;
    const double window = size * overlap(static_cast<float>(u), static_cast<float>(half), helix_begin_, helix_end_);
    cosine.push_back(static_cast<float>(-window * std::cos(turn)));
    sine.push_back(static_cast<float>(window * std::sin(turn)));
  }
}

std::vector<double> SleevePattern::rotationGuesses() const {
  std::vector<double> guesses;
  for (int k = 0; k < kGuesses; ++k) guesses.push_back(2 * M_PI * k / kGuesses);
  return guesses;
}

}  // namespace vibe::vision
