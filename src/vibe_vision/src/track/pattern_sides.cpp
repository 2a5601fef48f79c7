#include <algorithm>

#include <Eigen/Cholesky>

#include "track/arithmetic.hpp"
#include "track/pattern_fit.hpp"

namespace vibe::vision {

void PatternFit::measureMotion(int k, const PixelBlock& pixels, double by) {
  const std::size_t count = pixels.padded();
  std::copy_n(values_.value.data(), count, before_.data());
  evaluate(at_, pixels);
  const auto factor = static_cast<float>(at_[kContrast] / by);
  for (std::size_t i = 0; i < count; ++i) moved_[k][i] = lit_[i] * factor * (values_.value[i] - before_[i]);
  std::copy_n(before_.data(), count, values_.value.data());
}

PatternFit::Sides PatternFit::sides(const PixelBlock& pixels, const RodLight& light, const SideLimits& limits,
                                    const MarkerMotion& motion) const {
  constexpr int kFirst = RodLight::kPlaces;
  Sides s;
  s.left.setZero(), s.right.setZero(), s.common.setZero(columns_, kSides);
  light.addPrior(limits.light, s.left.topLeftCorner<kFirst, kFirst>(), s.right.head<kFirst>());
  const bool moves = limits.motion.length > 0;
  const Eigen::Vector3d deviation(limits.motion.length, limits.motion.bend, limits.motion.turn);
  const Eigen::Vector3d known = moves ? Eigen::Vector3d(deviation.cwiseAbs2().cwiseInverse()) : Eigen::Vector3d::Ones();
  s.left.diagonal().tail<kMotionSides>() = known;
  if (moves) s.right.tail<2>() << -motion.bend * known[1], -motion.turn * known[2];
  const auto black = static_cast<float>(at_[kBlack]), contrast = static_cast<float>(at_[kContrast]);
  const float* residual = equations_.column(NormalEquations::kMaxColumns);
  for (std::size_t i = 0; i < pixels.count; ++i) {
    const float p = light.placeOf(pixels.along[i], pixels.lateral[i]);
    const int k = static_cast<int>(p);
    const double c = lit_[i] * (black + contrast * values_.value[i]), b = c * (p - static_cast<float>(k)), a = c - b;
    s.left(k, k) += a * a, s.left(k + 1, k + 1) += b * b, s.left(k + 1, k) += a * b, s.left(k, k + 1) += a * b;
    s.right[k] += a * residual[i], s.right[k + 1] += b * residual[i];
    for (int j = 0; j < columns_; ++j) {
      const double d = equations_.column(j)[i];
      s.common(j, k) += a * d, s.common(j, k + 1) += b * d;
    }
    for (int m = 0; moves && m < kMotionSides; ++m) {
      const double d = moved_[m][i];
      s.left(kFirst + m, k) += a * d, s.left(kFirst + m, k + 1) += b * d;
      s.left(k, kFirst + m) += a * d, s.left(k + 1, kFirst + m) += b * d;
    }
  }
  for (int m = 0; moves && m < kMotionSides; ++m) {
    const float* d = moved_[m].data();
    s.right[kFirst + m] += dot(d, residual, pixels.padded());
    for (int j = 0; j < columns_; ++j) s.common(j, kFirst + m) = dot(d, equations_.column(j), pixels.padded());
    for (int n = 0; n < kMotionSides; ++n) s.left(kFirst + m, kFirst + n) += dot(d, moved_[n].data(), pixels.padded());
  }
  return s;
}

FitMatrix PatternFit::covariance(const PixelBlock& pixels, const RodLight& light, const SideLimits& limits) const {
  const Sides s = sides(pixels, light, limits, {});
  const FitSubmatrix h = factors_.reconstructedMatrix() - s.common * s.left.ldlt().solve(s.common.transpose());
  return spread(h.ldlt().solve(FitSubmatrix::Identity(columns_, columns_)));
}

MarkerMotion PatternFit::stepWithLight(const PixelBlock& pixels, RodLight& light, const SideLimits& limits,
                                       const MarkerMotion& motion, FitStep& step) const {
  light.moveTo(poseOf(at_));
  const Sides s = sides(pixels, light, limits, motion);
  const Eigen::LDLT<Eigen::Matrix<double, kSides, kSides>> inverse(s.left);
  const FitSubmatrix h = factors_.reconstructedMatrix() - s.common * inverse.solve(s.common.transpose());
  const FitSubvector change = h.ldlt().solve(gradient_ - s.common * inverse.solve(s.right));
  if (!change.allFinite()) return {};
  for (int a = 0; a < columns_; ++a) step.change[parameter_[a]] = change[a];
  const Eigen::Matrix<double, kSides, 1> side = inverse.solve(s.right - s.common.transpose() * change);
  light.change(side.head<RodLight::kPlaces>());
  return {side[RodLight::kPlaces], side[RodLight::kPlaces + 1], side[RodLight::kPlaces + 2]};
}

}  // namespace vibe::vision
