#include <algorithm>
#include <array>
#include <cmath>

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

Distortions PatternFit::distortions(const FitPrior& unlearnt, const PixelBlock& pixels, const Sight& sight) {
  const FitVector& x = at_;
  const auto contrast = static_cast<float>(x[kContrast]);
  const auto x0 = static_cast<float>(x[kAlong]), y0 = static_cast<float>(x[kLateral]);
  const auto down_x = static_cast<float>(sight.down.x()), down_y = static_cast<float>(sight.down.y());
  const float *by_along = values_.derivative[kAlong].data(), *by_lateral = values_.derivative[kLateral].data();
  // what a change does to each pixel, of what its light and contrast are and its place from the middle
  const auto told = [&](const Eigen::LDLT<FitSubmatrix>& factors, const FitSubvector& g, const auto& change) {
    float* column = equations_.column(columns_);
    for (std::size_t i = 0; i < pixels.padded(); ++i)
      column[i] = change(i, lit_[i] * contrast, pixels.along[i] - x0, pixels.lateral[i] - y0);
    return distortion(factors, g, pixels.padded());
  };
  Distortions found;
  found.shear = told(factors_, gradient_, [&](std::size_t i, float shade, float u, float v) {
    return shade * (down_x * u + down_y * v) * by_along[i];
  });
  FitSubmatrix h;
  FitSubvector g;
  assemble(x, unlearnt, h, g);
  const Eigen::LDLT<FitSubmatrix> factors(h);
  const auto per_area = static_cast<float>(1 / square(pattern_->rim() * std::exp(x[kLogScale])));
  const auto slope = static_cast<float>(sight.slope), per_pixel = static_cast<float>(sight.per_pixel);
  found.relief = told(factors, g, [&](std::size_t i, float shade, float u, float) {
    return shade * per_area * u * u * (slope + per_pixel * u) * by_along[i];
  });
  if (observed_[kRotation]) {
    found.oval = oval(factors, g, pixels, sight);
    return found;
  }
  found.bend = told(factors, g, [&](std::size_t i, float shade, float u, float v) {
    return shade * per_area * (v * v * v * by_lateral[i] - u * u * u * by_along[i]);
  });
  return found;
}

Distortion PatternFit::towards(MarkerPattern& other, const PixelBlock& pixels) {
  const std::size_t count = pixels.padded();
  const auto contrast = static_cast<float>(at_[kContrast]);
  std::copy_n(values_.value.data(), count, before_.data());
  other.evaluate(poseOf(at_), pixels, values_);
  float* column = equations_.column(columns_);
  for (std::size_t i = 0; i < count; ++i) column[i] = lit_[i] * contrast * (values_.value[i] - before_[i]);
  pattern_->evaluate(poseOf(at_), pixels, values_);
  return distortion(factors_, gradient_, count);
}

/// A line of sight meets a wider rod at a place nearer to its middle.
std::array<Distortion, 2> PatternFit::oval(const Eigen::LDLT<FitSubmatrix>& factors, const FitSubvector& g,
                                           const PixelBlock& pixels, const Sight& sight) {
  const float* slope = values_.derivative[kRotation].data();
  const auto sine = static_cast<float>(std::sin(at_[kTilt]) / sight.radius);
  const auto cosine = static_cast<float>(std::cos(at_[kTilt]) / sight.radius);
  const auto x0 = static_cast<float>(at_[kAlong]), y0 = static_cast<float>(at_[kLateral]);
  const auto contrast = static_cast<float>(at_[kContrast]);
  std::array<Distortion, 2> found;
  for (std::size_t k = 0; k < 2; ++k) {
    const double turn = 2 * at_[kRotation] + static_cast<double>(k) * M_PI / 2;
    const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
    float* column = equations_.column(columns_);
    for (std::size_t i = 0; i < pixels.padded(); ++i) {
      const float v = cosine * (pixels.lateral[i] - y0) - sine * (pixels.along[i] - x0);
      const float sin_phi = std::max(-0.95F, std::min(v, 0.95F)), cos_phi = std::sqrt(1 - sin_phi * sin_phi);
      const float wider = c * (1 - 2 * sin_phi * sin_phi) + s * 2 * sin_phi * cos_phi;
      column[i] = lit_[i] * contrast * slope[i] * wider * sin_phi / cos_phi;
    }
    found[k] = distortion(factors, g, pixels.padded());
  }
  return found;
}

Distortion PatternFit::stretch(const FitPrior& unlearnt, const PixelBlock& pixels) {
  FitSubmatrix h;
  FitSubvector g;
  assemble(at_, unlearnt, h, g);
  std::copy_n(moved_[0].data(), pixels.padded(), equations_.column(columns_));
  return distortion(Eigen::LDLT<FitSubmatrix>(h), g, pixels.padded());
}

double PatternFit::stripeSeen(const PixelBlock& pixels) const {
  const std::vector<float>& slope = values_.derivative[kRotation];
  float used = 0, full = 0;
  for (std::size_t i = 0; i < pixels.padded(); ++i) {
    const float told = slope[i] * slope[i];
    used += weight_[i] * told;
    full += told;
  }
  return full > 0 ? used / full : 0;
}

double PatternFit::oddRows(const PixelBlock& pixels, const Eigen::Vector2d& down) const {
  constexpr int kBands = 64;  // of two rows
  std::array<float, kBands> used{}, full{};
  const auto x = static_cast<float>(down.x() / 2), y = static_cast<float>(down.y() / 2);
  const auto first = static_cast<float>(kBands / 2 - x * at_[kAlong] - y * at_[kLateral]);
  for (std::size_t i = 0; i < pixels.count / 2; ++i) {  // which sample all of the window
    const float place = first + x * pixels.along[i] + y * pixels.lateral[i];
    const auto band = static_cast<std::size_t>(std::clamp(place, 0.F, kBands - 1.F));
    used[band] += weight_[i] * information_[i];
    full[band] += pixels.weight[i] * information_[i];
  }
  float odd = 0, all = 0;
  for (std::size_t i = 0; i < kBands; ++i) {
    odd += used[i] < full[i] / 2 ? full[i] : 0;
    all += full[i];
  }
  return all > 0 ? odd / all : 0;
}

}  // namespace vibe::vision
