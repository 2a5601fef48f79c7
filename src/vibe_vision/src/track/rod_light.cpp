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
// The same of the sheen, relative to the mean grey value, which is narrower; and from which it is part of the model.
constexpr double kSheenDrift = 0.02, kSheenBend = 0.3, kNoticeableSheen = 0.15;
constexpr int kPlain = 3;  // places of a rod at least that mirror no lamp

/// The second derivative of values at places is about 0. @param left  lower part of normal equations
template <class Left>
void smoothen(Left&& left, double deviation) {
  const Eigen::Vector3d bend = Eigen::Vector3d(1, -2, 1) / deviation;
  for (int k = 0; k + 2 < left.rows(); ++k)
    left.template block<3, 3>(k, k).template triangularView<Eigen::Lower>() += bend * bend.transpose();
}

}  // namespace

void RodLight::addPrior(double deviation, Eigen::Ref<Lights> left, Eigen::Ref<Vector> right) const {
  left.diagonal().array() += 1 / square(deviation);
  for (int k = 0; k + 2 < kPlaces; ++k) {
    const Eigen::Vector3d row = Eigen::Vector3d(factor_[k], -2 * factor_[k + 1], factor_[k + 2]) / kBend;
    left.block<3, 3>(k, k) += row * row.transpose();
    right.segment<3>(k) -= row * row.sum();
  }
}

void RodLight::reset() {
  factor_.setOnes();
  sheen_.setZero();
  known_ = shines_ = placed_ = false;
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
  level_ = sum / count;
  rows_ = rowsOf(pose);
  factor_.setOnes();
  guessSheen(pixels);
  begin(pose);
  placed_ = shines_;
  const double weight = 1 / square(kGuessDeviation * sum / count * kPlaces);
  for (std::size_t i = 0; i < pixels.count; ++i)
    add(pixels.along[i], pixels.lateral[i], pixels.value[i], sum / count, pixels.weight[i] * weight);
  solve(Vector::Ones(), 1e-6);
}

/// Where a lamp is mirrored, a row is brighter than most, but its black and white differ as much as elsewhere. Rows
/// that are only less distinct, as in a long exposure, mirror nothing.
void RodLight::guessSheen(const PixelBlock& pixels) {
  Vector count = Vector::Zero(), sum = count, squares = count;
  for (std::size_t i = 0; i < pixels.count; ++i) {
    const int k = static_cast<int>(rows_.at(pixels.along[i], pixels.lateral[i]) + 0.5F);
    const double value = pixels.weight[i] * pixels.value[i];
    count[k] += pixels.weight[i], sum[k] += value, squares[k] += value * pixels.value[i];
  }
  const Vector mean = sum.cwiseQuotient(count.cwiseMax(1));
  const Vector spread = (squares.cwiseQuotient(count.cwiseMax(1)) - mean.cwiseAbs2()).cwiseMax(1).cwiseSqrt();
  Vector ratio = mean.cwiseQuotient(spread);
  for (int k = 0; k < kPlaces; ++k)
    if (count[k] < 1) ratio[k] = 1e9;
  const Vector all = ratio;
  std::nth_element(ratio.data(), ratio.data() + kPlain - 1, ratio.data() + kPlaces);
  Vector sorted = mean;
  std::nth_element(sorted.data(), sorted.data() + kPlaces / 2, sorted.data() + kPlaces);
  sheen_ = (mean - ratio[kPlain - 1] * spread).cwiseMin(mean - Vector::Constant(sorted[kPlaces / 2]));
  sheen_ = sheen_.cwiseMax(0);
  for (int k = 0; k < kPlaces; ++k)
    if (all[k] == 1e9) sheen_[k] = 0;
  shines_ = placed_ = sheen_.maxCoeff() > kNoticeableSheen * level_;
  if (!shines_) sheen_.setZero();
}

void RodLight::shine(const MarkerPose& pose, PixelBlock& pixels, std::size_t count) const {
  if (!isRound()) return;
  const Rows rows = placed_ ? rows_ : rowsOf(pose);
  float factor[kPlaces], sheen[kPlaces];
  for (int k = 0; k < kPlaces; ++k)
    factor[k] = static_cast<float>(factor_[k]), sheen[k] = static_cast<float>(sheen_[k]);
  for (std::size_t i = 0; i < count; ++i) {
    const float p = rows.at(pixels.along[i], pixels.lateral[i]);
    const int k = static_cast<int>(p);
    pixels.light[i] = factor[k] + (p - static_cast<float>(k)) * (factor[k + 1] - factor[k]);
    pixels.sheen[i] = sheen[k] + (p - static_cast<float>(k)) * (sheen[k + 1] - sheen[k]);
  }
}

void RodLight::begin(const MarkerPose& pose) {
  const Rows before = rows_;
  rows_ = rowsOf(pose);
  left_.setZero();
  right_.setZero();
  if (!placed_) return;
  const Vector seen = sheen_;  // which stays at the same rows of the image
  for (int k = 0; k < kPlaces; ++k) {
    const float across = (static_cast<float>(k) - (kPlaces - 1) / 2) / rows_.per_pixel;
    const float p = before.at(before.along, rows_.lateral + across);
    const int i = static_cast<int>(p);
    sheen_[k] = seen[i] + (p - static_cast<float>(i)) * (seen[i + 1] - seen[i]);
  }
  placed_ = false;
}

/// A pixel between two places shows the light of both, and the sheen.
void RodLight::add(double along, double lateral, double value, double plain, double weight) {
  const double p = rows_.at(static_cast<float>(along), static_cast<float>(lateral));
  const int k = static_cast<int>(p);
  const double b = p - k, a = 1 - b, wp = weight * plain;
  left_(k, k) += wp * plain * a * a;
  left_(k + 1, k) += wp * plain * a * b;
  left_(k + 1, k + 1) += wp * plain * b * b;
  right_[k] += wp * a * value;
  right_[k + 1] += wp * b * value;
  if (!shines_) return;
  const int s = k + kPlaces;
  left_(s, s) += weight * a * a;
  left_(s + 1, s) += weight * a * b;
  left_(s + 1, s + 1) += weight * b * b;
  left_(s, k) += wp * a * a;
  left_(s, k + 1) += wp * a * b;
  left_(s + 1, k) += wp * a * b;
  left_(s + 1, k + 1) += wp * b * b;
  right_[s] += weight * a * value;
  right_[s + 1] += weight * b * value;
}

void RodLight::learn() {
  solve(factor_, 1 / square(kDrift));
  known_ = true;
}

/// The mean of the light is in the grey values of black and white, and what all rows share of the sheen in that of
/// black.
void RodLight::solve(const Vector& near, double information) {
  for (int k = 0; k < kPlaces; ++k) left_(k, k) += information;
  right_.head<kPlaces>() += information * near;
  smoothen(left_.topLeftCorner<kPlaces, kPlaces>(), kBend);
  Vector factor;
  if (shines_) {
    const double inertia = 1 / square(kSheenDrift * level_);
    for (int k = kPlaces; k < 2 * kPlaces; ++k) left_(k, k) += inertia;
    right_.tail<kPlaces>() += inertia * sheen_;
    smoothen(left_.bottomRightCorner<kPlaces, kPlaces>(), kSheenBend * level_);
    const Both both = left_.selfadjointView<Eigen::Lower>().ldlt().solve(right_);
    if (!both.allFinite()) return;
    factor = both.head<kPlaces>();
    sheen_ = both.tail<kPlaces>().array() - both.tail<kPlaces>().minCoeff();
  } else {
    factor =
        left_.topLeftCorner<kPlaces, kPlaces>().selfadjointView<Eigen::Lower>().ldlt().solve(right_.head<kPlaces>());
  }
  if (!factor.allFinite()) return;
  factor_ = factor.cwiseMax(kDarkest * factor.maxCoeff());
  factor_ /= factor_.mean();
}

double RodLight::raise(double power) {
  for (int k = 0; k < kPlaces; ++k) factor_[k] = std::pow(factor_[k], power);
  if (!shines_) return 1;
  const double sheen = power * std::pow(level_ / 255, power - 1);
  level_ *= sheen / power;
  sheen_ *= sheen;
  return sheen;
}

}  // namespace vibe::vision
