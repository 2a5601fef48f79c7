#include "track/pattern_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "track/float_sums.hpp"

namespace vibe {
namespace {

constexpr double kOutlier = 6;  // standard deviations beyond which a pixel counts nothing
constexpr double kCut = kOutlier * kOutlier;

// Moments of the biweight for normal residuals t: E[w], E[w t^2] (also E[d(w t)/dt]), E[w^2 t^2]; tails beyond the cut
// are 2e-9. (Huber, Ronchetti, "Robust Statistics", 2009, section 3.2: variance of an M-estimator.)
constexpr double kMeanWeight = 1 - 2 / kCut + 3 / (kCut * kCut);
constexpr double kMeanSquare = 1 - 6 / kCut + 15 / (kCut * kCut);
constexpr double kScoreSquare = 1 - 12 / kCut + 90 / (kCut * kCut) - 420 / (kCut * kCut * kCut);
constexpr double kVarianceFactor = kScoreSquare * kMeanWeight / (kMeanSquare * kMeanSquare);

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kFitParameters, kFitParameters>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kFitParameters, 1>;

/// Median of the pixels that have at least, or at most, this reflectance.
class LevelHistogram {
 public:
  void add(float value, float reflectance) {
    ++counts_[static_cast<std::size_t>(std::clamp(value, 0.F, 255.F))];
    ++count_;
    reflectance_ += reflectance;
  }
  int count() const { return count_; }
  double reflectance() const { return reflectance_ / count_; }
  double median() const {
    int below = 0, i = 0;
    while (2 * (below + counts_[i]) < count_) below += counts_[i++];
    return i + (0.5 * count_ - below) / counts_[i] - 0.5;
  }

 private:
  std::array<int, 256> counts_{};
  int count_ = 0;
  double reflectance_ = 0;
};

}  // namespace

MarkerPose poseOf(const FitVector& x) {
  MarkerPose pose;
  pose.along = x[kAlong], pose.lateral = x[kLateral], pose.rotation = x[kRotation];
  pose.log_scale = x[kLogScale], pose.tilt = x[kTilt], pose.log_aspect = x[kLogAspect];
  pose.blur = x[kBlur], pose.keystone = x[kKeystone], pose.slant = x[kSlant];
  return pose;
}

void setPose(const MarkerPose& pose, FitVector& x) {
  x.head<kPoseParameters>() << pose.along, pose.lateral, pose.rotation, pose.log_scale, pose.tilt, pose.log_aspect,
      pose.blur, pose.keystone, pose.slant;
}

PatternFit::PatternFit(MarkerPattern& pattern, const PixelNoise& noise, std::size_t capacity)
    : pattern_(pattern),
      noise_(noise),
      observed_(pattern.observes()),
      factor_(capacity + kLanes),
      weight_(factor_),
      rest_(factor_),
      information_(factor_),
      white_(factor_),
      equations_(capacity) {
  values_.allocate(capacity, observed_);
}

void PatternFit::evaluate(const FitVector& x, const PixelBlock& pixels) {
  pattern_.evaluate(poseOf(x), pixels, values_);
}

void PatternFit::startLevels(const PixelBlock& pixels, FitVector& x) const {
  float low = 1, high = 0;
  for (std::size_t i = 0; i < pixels.count; ++i) {
    low = std::min(low, values_.value[i]);
    high = std::max(high, values_.value[i]);
  }
  const float margin = 0.15F * (high - low);
  LevelHistogram black, white;
  for (std::size_t i = 0; i < pixels.count; ++i) {
    if (pixels.weight[i] == 0) continue;
    if (values_.value[i] <= low + margin) black.add(pixels.value[i], values_.value[i]);
    if (values_.value[i] >= high - margin) white.add(pixels.value[i], values_.value[i]);
  }
  x[kBlack] = x[kContrast] = 0;
  if (black.count() == 0 || white.count() == 0 || high - low < 1e-3F) return;
  x[kContrast] = (white.median() - black.median()) / (white.reflectance() - black.reflectance());
  x[kBlack] = black.median() - x[kContrast] * black.reflectance();
}

FitStep PatternFit::step(const FitVector& x, const FitPrior& prior, const PixelBlock& pixels,
                         const FitOptions& options) {
  FitStep result;
  chooseColumns(options.scope);
  weigh(x, pixels, options);
  fillColumns(x, pixels);
  equations_.sum(pixels.padded());
  solve(x, prior, result);
  result.visible = full_ > 0 ? used_ / full_ : 0;
  const double white = used_white_ / std::max(full_white_, 1e-9);
  const double black = (used_ - used_white_) / std::max(full_ - full_white_, 1e-9);
  result.weaker_edges = std::min(white, black);
  result.loss = valid_ > 0 ? loss_ / valid_ : 1;
  const double freedom = weights_ / kMeanWeight - columns_;
  result.misfit = freedom > 0 ? squares_ / kMeanSquare / freedom : 0;
  return result;
}

double PatternFit::loss(const FitVector& x, const PixelBlock& pixels, const FitOptions& options) {
  weigh(x, pixels, options);
  return valid_ > 0 ? loss_ / valid_ : 1;
}

void PatternFit::chooseColumns(FitScope scope) {
  columns_ = 0;
  const auto wanted = [scope](int k) {
    if (scope == FitScope::Position) return k <= kRotation || k == kBlack || k == kContrast;
    return scope == FitScope::All || (k != kBlur && k < kSlopeAlong);
  };
  for (int k = 0; k < kFitParameters; ++k)
    if ((k >= kPoseParameters || observed_[k]) && wanted(k)) parameter_[columns_++] = k;
  equations_.start(columns_);
}

/// Fills factor_ and the residuals, and sums what tells how well the pattern explains the pixels.
void PatternFit::weigh(const FitVector& x, const PixelBlock& pixels, const FitOptions& options) {
  const auto black = static_cast<float>(x[kBlack]), contrast = static_cast<float>(x[kContrast]);
  const auto slope_x = static_cast<float>(x[kSlopeAlong]), slope_y = static_cast<float>(x[kSlopeLateral]);
  const auto centre_x = static_cast<float>(x[kAlong]), centre_y = static_cast<float>(x[kLateral]);
  const auto gain = static_cast<float>(noise_.gain), floor = static_cast<float>(noise_.read * noise_.read + 1e-3);
  const auto slack = static_cast<float>(options.uncertainty * options.uncertainty) * contrast * contrast;
  constexpr auto kInverseCut = static_cast<float>(1 / kCut);
  const float *m = values_.value.data(), *by_along = values_.derivative[kAlong].data();
  const float* by_lateral = values_.derivative[kLateral].data();
  const float *px = pixels.along.data(), *py = pixels.lateral.data(), *seen = pixels.value.data();
  const float* valid = pixels.weight.data();
  float* __restrict factor = factor_.data(), * __restrict residual = equations_.residual();
  float* __restrict weight = weight_.data(), * __restrict rest = rest_.data(), * __restrict information = information_.data();
  float* white = white_.data();
  const float* by_scale = values_.derivative[kLogScale].data();
  const std::size_t count = pixels.padded();
  const Four zero{}, one = zero + 1;
  for (std::size_t i = 0; i < count; i += 4) {
    const Four light = one + slope_x * (loadFour(px + i) - centre_x) + slope_y * (loadFour(py + i) - centre_y);
    const Four grey = (black + contrast * loadFour(m + i)) * light, usable = loadFour(valid + i);
    const Four along = loadFour(by_along + i), lateral = loadFour(by_lateral + i);
    const Four steep = along * along, slope = steep + lateral * lateral;
    const Four inverse = one / (floor + gain * greater(grey, zero) + slack * slope);
    const Four r = loadFour(seen + i) - grey, kept = greater(one - r * r * inverse * kInverseCut, zero);
    const Four share = usable * kept * kept, root = usable * kept * squareRoot(inverse);
    store(weight + i, share);
    store(factor + i, root);
    store(residual + i, root * r);
    store(rest + i, share * kept);
    store(information + i, inverse * steep);
    store(white + i, loadFour(by_scale + i) > zero ? inverse * steep : zero);
  }
  squares_ = dot(residual, residual, count);
  weights_ = total(weight, count);
  valid_ = total(valid, count);
  loss_ = valid_ - total(rest, count);
  used_ = dot(weight, information, count);
  full_ = total(information, count);
  used_white_ = dot(weight, white, count);
  full_white_ = total(white, count);
}

void PatternFit::fillColumns(const FitVector& x, const PixelBlock& pixels) {
  const auto black = static_cast<float>(x[kBlack]), contrast = static_cast<float>(x[kContrast]);
  const auto slope_x = static_cast<float>(x[kSlopeAlong]), slope_y = static_cast<float>(x[kSlopeLateral]);
  const auto centre_x = static_cast<float>(x[kAlong]), centre_y = static_cast<float>(x[kLateral]);
  const float *px = pixels.along.data(), *py = pixels.lateral.data(), *m = values_.value.data();
  const float* factor = factor_.data();
  const std::size_t count = pixels.padded();
  const auto light = [&](std::size_t i) { return 1 + slope_x * (px[i] - centre_x) + slope_y * (py[i] - centre_y); };
  for (int c = 0; c < columns_; ++c) {
    float* out = equations_.column(c);
    const int k = parameter_[c];
    if (k < kPoseParameters) {
      const float* d = values_.derivative[k].data();
      for (std::size_t i = 0; i < count; ++i) out[i] = factor[i] * contrast * light(i) * d[i];
    } else if (k == kBlack) {
      for (std::size_t i = 0; i < count; ++i) out[i] = factor[i] * light(i);
    } else if (k == kContrast) {
      for (std::size_t i = 0; i < count; ++i) out[i] = factor[i] * light(i) * m[i];
    } else {
      const float* p = k == kSlopeAlong ? px : py;
      const float centre = k == kSlopeAlong ? centre_x : centre_y;
      for (std::size_t i = 0; i < count; ++i) out[i] = factor[i] * (black + contrast * m[i]) * (p[i] - centre);
    }
  }
}

void PatternFit::solve(const FitVector& x, const FitPrior& prior, FitStep& result) const {
  Square h(columns_, columns_);
  Column g(columns_);
  for (int a = 0; a < columns_; ++a) {
    g[a] = equations_.gradient(a);
    for (int b = 0; b < columns_; ++b) {
      h(a, b) = equations_.product(a, b) + prior.information(parameter_[a], parameter_[b]);
      g[a] += prior.information(parameter_[a], parameter_[b]) * (prior.mean[parameter_[b]] - x[parameter_[b]]);
    }
  }
  const Eigen::LDLT<Square> factors(h);
  result.valid = factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0;
  if (!result.valid) return;
  const Column change = factors.solve(g);
  const Square inverse = factors.solve(Square::Identity(columns_, columns_)) * kVarianceFactor;
  result.valid = change.allFinite();
  for (int a = 0; a < columns_; ++a) {
    result.change[parameter_[a]] = change[a];
    for (int b = 0; b < columns_; ++b) result.covariance(parameter_[a], parameter_[b]) = inverse(a, b);
  }
}

}  // namespace vibe
