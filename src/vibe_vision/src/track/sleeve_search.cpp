#include <algorithm>
#include <cmath>

#include "track/sleeve_pattern.hpp"

namespace vibe {
namespace {

constexpr double kSearchRim = 0.6;  // of the radius: rows that show the same bars
constexpr int kGuesses = 8;

}  // namespace

double SleevePattern::searchHalfWidth() const {
  return kSearchRim * radius_;
}

void SleevePattern::searchProfile(double motion, std::vector<float>& profile) const {
  const double half = std::max(half_length_ - 1 - std::abs(motion) / 2, 0.3 * half_length_);
  const auto steps = static_cast<std::ptrdiff_t>(half);
  const float shift = static_cast<float>(std::max(std::abs(motion), 1.0) / 2), variance = 0.5F;
  profile.resize(static_cast<std::size_t>(2 * steps + 1));
  for (std::ptrdiff_t k = -steps; k <= steps; ++k) {
    const auto u = static_cast<float>(k);
    const float black = (bars_.at(u + shift, variance).integral - bars_.at(u - shift, variance).integral) / (2 * shift);
    const float helix =
        std::clamp(std::min(u + shift, helix_end_) - std::max(u - shift, helix_begin_), 0.0F, 2 * shift);
    profile[static_cast<std::size_t>(k + steps)] = 1 - black - helix / (2 * shift) * stripe_.mean();
  }
}

std::vector<double> SleevePattern::rotationGuesses() const {
  std::vector<double> guesses;
  for (int k = 0; k < kGuesses; ++k) guesses.push_back(2 * M_PI * k / kGuesses);
  return guesses;
}

}  // namespace vibe
