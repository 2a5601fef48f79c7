#include "track/rod_light.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {
namespace {

constexpr double kSeen = 0.96;  // of the radius
// Standard deviations of the factors, design choices: from frame to frame, and of the bend from one place to the next,
// which at the edge of the lit side is about the spacing of the places.
constexpr double kDrift = 0.02, kBend = 0.05;
constexpr double kGuessDeviation = 0.05;  // of a row's mean
constexpr double kDarkest = 0.02;

}  // namespace

void RodLight::reset() {
  factor_.setOnes();
  known_ = false;
}

RodLight::Rows RodLight::rowsOf(const MarkerPose& pose) const {
  const double spacing = 2 * kSeen / (kPlaces - 1) * radius_ * std::exp(pose.log_scale);
  return {static_cast<float>(pose.along), static_cast<float>(pose.lateral), static_cast<float>(std::cos(pose.tilt)),
          static_cast<float>(std::sin(pose.tilt)), static_cast<float>(1 / spacing)};
}

void RodLight::guess(const MarkerPose& pose, const PixelBlock& pixels) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pixels.count; ++i) sum += pixels.weight[i] * pixels.value[i], count += pixels.weight[i];
  if (!isRound() || sum <= 0) return;
  begin(pose);
  const double weight = 1 / square(kGuessDeviation * sum / count * kPlaces);
  for (std::size_t i = 0; i < pixels.count; ++i)
    add(pixels.along[i], pixels.lateral[i], pixels.value[i], sum / count, pixels.weight[i] * weight);
  solve(Vector::Ones(), 1e-6);
}

void RodLight::shine(const MarkerPose& pose, PixelBlock& pixels, std::size_t count) const {
  if (!isRound()) return;
  const Rows rows = rowsOf(pose);
  float factor[kPlaces];
  for (int k = 0; k < kPlaces; ++k) factor[k] = static_cast<float>(factor_[k]);
  for (std::size_t i = 0; i < count; ++i) {
    const float p = rows.at(pixels.along[i], pixels.lateral[i]);
    const int k = static_cast<int>(p);
    pixels.light[i] = factor[k] + (p - static_cast<float>(k)) * (factor[k + 1] - factor[k]);
  }
}

void RodLight::begin(const MarkerPose& pose) {
  rows_ = rowsOf(pose);
  left_.setZero();
  right_.setZero();
}

void RodLight::add(double along, double lateral, double value, double plain, double weight) {
  const double p = rows_.at(static_cast<float>(along), static_cast<float>(lateral));
  const int k = static_cast<int>(p);
  const double b = p - k, a = 1 - b, wp = weight * plain;
  left_(k, k) += wp * plain * a * a;
  left_(k + 1, k) += wp * plain * a * b;
  left_(k + 1, k + 1) += wp * plain * b * b;
  right_[k] += wp * a * value;
  right_[k + 1] += wp * b * value;
}

void RodLight::learn() {
  solve(factor_, 1 / square(kDrift));
  known_ = true;
}

/// The mean of the light is in the grey values of black and white.
void RodLight::solve(const Vector& near, double information) {
  for (int k = 0; k < kPlaces; ++k) left_(k, k) += information;
  right_ += information * near;
  const Eigen::Vector3d bend = Eigen::Vector3d(1, -2, 1) / kBend;
  for (int k = 0; k + 2 < kPlaces; ++k)
    left_.block<3, 3>(k, k).triangularView<Eigen::Lower>() += bend * bend.transpose();
  const Vector factor = left_.selfadjointView<Eigen::Lower>().ldlt().solve(right_);
  if (!factor.allFinite()) return;
  factor_ = factor.cwiseMax(kDarkest * factor.maxCoeff());
  factor_ /= factor_.mean();
}

void RodLight::raise(double power) {
  for (int k = 0; k < kPlaces; ++k) factor_[k] = std::pow(factor_[k], power);
}

}  // namespace vibe::vision
