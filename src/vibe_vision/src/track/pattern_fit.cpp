#include "track/pattern_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "track/arithmetic.hpp"

namespace vibe::vision {

namespace {

constexpr std::size_t kRowsAtATime = 256;  // rows summed in single precision before they are added in double precision

constexpr std::size_t kTogether = 4;  // columns

/// Adds the products of column a with some others to `sums`, in the order of total() of arithmetic.hpp.
VIBE_LANES void addProducts(const float* a, const std::array<const float*, kTogether>& others, std::size_t count,
                            std::array<double, kTogether>& sums) {
  const float *p = others[0], *q = others[1], *r = others[2], *s = others[3];
  Eight sum[kTogether] = {};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Eight v = *reinterpret_cast<const Eight*>(a + i);
    sum[0] += v * *reinterpret_cast<const Eight*>(p + i);
    sum[1] += v * *reinterpret_cast<const Eight*>(q + i);
    sum[2] += v * *reinterpret_cast<const Eight*>(r + i);
    sum[3] += v * *reinterpret_cast<const Eight*>(s + i);
  }
  for (std::size_t k = 0; k < kTogether; ++k) {
    const float* e = reinterpret_cast<const float*>(&sum[k]);
    sums[k] = (static_cast<double>(e[0] + e[4]) + (e[1] + e[5])) + (static_cast<double>(e[2] + e[6]) + (e[3] + e[7]));
  }
}

constexpr double kOutlier = 6;  // standard deviations beyond which a pixel counts nothing
constexpr double kCut = kOutlier * kOutlier;
constexpr float kSheenDoubt = 0.4F;  // of what a lamp's line adds: it is narrow

// Moments of the biweight for normal residuals t: E[w], E[w t^2] (also E[d(w t)/dt]), E[w^2 t^2]; tails beyond the cut
// are 2e-9. (Huber, Ronchetti, "Robust Statistics", 2009, section 3.2: variance of an M-estimator.)
constexpr double kMeanWeight = 1 - 2 / kCut + 3 / (kCut * kCut);
constexpr double kMeanSquare = 1 - 6 / kCut + 15 / (kCut * kCut);
constexpr double kScoreSquare = 1 - 12 / kCut + 90 / (kCut * kCut) - 420 / (kCut * kCut * kCut);
constexpr double kVarianceFactor = kScoreSquare * kMeanWeight / (kMeanSquare * kMeanSquare);

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

NormalEquations::NormalEquations(std::size_t capacity) : capacity_((capacity + kLanes - 1) / kLanes * kLanes) {
  columns_.assign(capacity_ * (kMaxColumns + 1), 0);
  products_.setZero();
}

void NormalEquations::start(int columns) {
  count_ = columns;
  products_.setZero();
}

void NormalEquations::sum(std::size_t count) {
  for (std::size_t begin = 0; begin < count; begin += kRowsAtATime)
    for (int a = 0; a < count_; ++a)
      for (int b = a; b <= count_; b += kTogether) sumGroup(a, b, begin, std::min(kRowsAtATime, count - begin));
}

/// Column a with column b and those behind it; column count_ stands for the residual.
void NormalEquations::sumGroup(int a, int b, std::size_t begin, std::size_t rows) {
  std::array<const float*, kTogether> others;
  std::array<double, kTogether> sums;
  for (int k = 0; k < static_cast<int>(kTogether); ++k)
    others[k] = (b + k < count_ ? column(b + k) : residual()) + begin;
  addProducts(column(a) + begin, others, rows, sums);
  for (int k = 0; k < static_cast<int>(kTogether) && b + k <= count_; ++k)
    products_(a, b + k < count_ ? b + k : kMaxColumns) += sums[k];
}

MarkerPose poseOf(const FitVector& x) {
  MarkerPose pose;
  pose.along = x[kAlong], pose.lateral = x[kLateral], pose.rotation = x[kRotation];
  pose.log_scale = x[kLogScale], pose.tilt = x[kTilt], pose.log_aspect = x[kLogAspect];
  pose.blur = x[kBlur], pose.keystone = x[kKeystone], pose.slant = x[kSlant];
  return pose;
}

PatternFit::PatternFit(MarkerPattern& pattern, const PixelNoise& noise, std::size_t capacity)
    : pattern_(&pattern),
      noise_(noise),
      observed_(pattern.observes()),
      factor_(capacity + kLanes),
      weight_(factor_),
      rest_(factor_),
      information_(factor_),
      white_(factor_),
      moved_({factor_, factor_, factor_}),
      before_(factor_),
      lit_(factor_),
      equations_(capacity) {
  values_.allocate(capacity, observed_);
}

void PatternFit::evaluate(const FitVector& x, const PixelBlock& pixels) {
  pattern_->evaluate(poseOf(x), pixels, values_);
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
    const float value = (pixels.value[i] - pixels.sheen[i]) / pixels.light[i];
    if (values_.value[i] <= low + margin) black.add(value, values_.value[i]);
    if (values_.value[i] >= high - margin) white.add(value, values_.value[i]);
  }
  x[kBlack] = x[kContrast] = 0;
  if (black.count() == 0 || white.count() == 0 || high - low < 1e-3F) return;
  x[kContrast] = (white.median() - black.median()) / (white.reflectance() - black.reflectance());
  x[kBlack] = black.median() - x[kContrast] * black.reflectance();
}

FitStep PatternFit::step(const FitVector& x, const FitPrior& prior, const PixelBlock& pixels,
                         const FitOptions& options) {
  FitStep result;
  chooseColumns(options);
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
  excess_ = std::max(1.0, result.misfit);
  return result;
}

double PatternFit::loss(const FitVector& x, const PixelBlock& pixels, const FitOptions& options) {
  weigh(x, pixels, options);
  return valid_ > 0 ? loss_ / valid_ : 1;
}

void PatternFit::chooseColumns(const FitOptions& options) {
  columns_ = 0;
  const FitScope scope = options.scope;
  const auto wanted = [&options, scope](int k) {
    if (k == kGamma) return options.response;
    if (scope == FitScope::Position) return k <= kRotation || k == kBlack || k == kContrast;
    return scope == FitScope::All || (k != kBlur && k < kSlopeAlong);
  };
  for (int k = 0; k < kFitParameters; ++k)
    if ((k >= kPoseParameters || observed_[k]) && wanted(k)) parameter_[columns_++] = k;
  equations_.start(columns_);
}

/// Fills factor_ and the residuals, and sums what tells how well the pattern explains the pixels.
void PatternFit::weigh(const FitVector& x, const PixelBlock& pixels, const FitOptions& options) {
  weighPixels(x, pixels, options);
  const std::size_t count = pixels.padded();
  squares_ = dot(equations_.residual(), equations_.residual(), count);
  weights_ = total(weight_.data(), count);
  valid_ = total(pixels.weight.data(), count);
  loss_ = valid_ - total(rest_.data(), count);
  used_ = dot(weight_.data(), information_.data(), count);
  full_ = total(information_.data(), count);
  used_white_ = dot(weight_.data(), white_.data(), count);
  full_white_ = total(white_.data(), count);
}

VIBE_LANES void PatternFit::weighPixels(const FitVector& x, const PixelBlock& pixels, const FitOptions& options) {
  const auto black = static_cast<float>(x[kBlack]), contrast = static_cast<float>(x[kContrast]);
  const auto slope_x = static_cast<float>(x[kSlopeAlong]), slope_y = static_cast<float>(x[kSlopeLateral]);
  const auto centre_x = static_cast<float>(x[kAlong]), centre_y = static_cast<float>(x[kLateral]);
  const auto gain = static_cast<float>(noise_.gain), floor = static_cast<float>(noise_.read * noise_.read + 1e-3);
  const auto slack = static_cast<float>(options.uncertainty * options.uncertainty) * contrast * contrast;
  constexpr auto kInverseCut = static_cast<float>(1 / kCut);
  const float* __restrict m = values_.value.data(), * __restrict by_along = values_.derivative[kAlong].data();
  const float* __restrict by_lateral = values_.derivative[kLateral].data();
  const float* __restrict by_scale = values_.derivative[kLogScale].data();
  const float* __restrict px = pixels.along.data(), * __restrict py = pixels.lateral.data();
  const float* __restrict seen = pixels.value.data(), * __restrict valid = pixels.weight.data();
  const float* __restrict lamp = pixels.light.data(), * __restrict sheen = pixels.sheen.data();
  float* __restrict factor = factor_.data(), * __restrict residual = equations_.residual();
  float* __restrict weight = weight_.data(), * __restrict rest = rest_.data();
  float* __restrict information = information_.data(), * __restrict white = white_.data();
  float* __restrict lit = lit_.data();
  const std::size_t count = pixels.padded() / kLanes * kLanes;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float light = lamp[i] * (1 + slope_x * (px[i] - centre_x) + slope_y * (py[i] - centre_y));
    const float grey = (black + contrast * m[i]) * light + sheen[i], steep = by_along[i] * by_along[i];
    const float slope = steep + by_lateral[i] * by_lateral[i];
    const float unsure = kSheenDoubt * sheen[i];
    const float inverse = 1 / (floor + gain * (grey > 0 ? grey : 0) + slack * slope + unsure * unsure);
    const float r = seen[i] - grey, left = 1 - r * r * inverse * kInverseCut, kept = left > 0 ? left : 0;
    const float share = valid[i] * kept * kept, root = valid[i] * kept * std::sqrt(inverse);
    weight[i] = share;
    factor[i] = root;
    lit[i] = root * light;
    residual[i] = root * r;
    rest[i] = share * kept;
    const float told = inverse * steep * light * light;
    information[i] = told;
    white[i] = by_scale[i] > 0 ? told : 0;
  }
}

VIBE_LANES void PatternFit::fillColumns(const FitVector& x, const PixelBlock& pixels) {
  const auto black = static_cast<float>(x[kBlack]), contrast = static_cast<float>(x[kContrast]);
  const float* __restrict m = values_.value.data(), * __restrict factor = factor_.data();
  const float* __restrict lit = lit_.data(), * __restrict lamp = pixels.light.data();
  const std::size_t count = pixels.padded() / kLanes * kLanes;
  for (int c = 0; c < columns_; ++c) {
    float* __restrict out = equations_.column(c);
    const int k = parameter_[c];
    if (k < kPoseParameters) {
      const float* __restrict d = values_.derivative[k].data();
      for (std::size_t i = 0; i < count; ++i) out[i] = lit[i] * contrast * d[i];
    } else if (k == kBlack) {
      std::copy_n(lit, count, out);
    } else if (k == kContrast) {
      for (std::size_t i = 0; i < count; ++i) out[i] = lit[i] * m[i];
    } else if (k == kGamma) {  // how much less a pixel means if the response is more curved
      const auto inverse = static_cast<float>(1 / x[kGamma]);
      for (std::size_t i = 0; i < count; ++i) {
        const float v = std::max(pixels.value[i], 0.1F);
        out[i] = -factor[i] * inverse * v * std::log(v / 255);
      }
    } else {
      const float* __restrict p = k == kSlopeAlong ? pixels.along.data() : pixels.lateral.data();
      const auto centre = static_cast<float>(x[k == kSlopeAlong ? kAlong : kLateral]);
      for (std::size_t i = 0; i < count; ++i)
        out[i] = factor[i] * lamp[i] * (black + contrast * m[i]) * (p[i] - centre);
    }
  }
}

void PatternFit::learnLight(const FitVector& x, const PixelBlock& pixels, RodLight& light) const {
  light.begin(poseOf(x));
  for (std::size_t i = 0; i < pixels.count; ++i) {
    const double slopes =
        1 + x[kSlopeAlong] * (pixels.along[i] - x[kAlong]) + x[kSlopeLateral] * (pixels.lateral[i] - x[kLateral]);
    light.add(pixels.along[i], pixels.lateral[i], pixels.value[i],
              (x[kBlack] + x[kContrast] * values_.value[i]) * slopes, factor_[i] * factor_[i]);
  }
  light.learn();
}

/// What the column behind those of the fit tells beside them.
Distortion PatternFit::distortion(const Eigen::LDLT<FitSubmatrix>& factors, const FitSubvector& g, std::size_t count) {
  const float* column = equations_.column(columns_);
  FitSubvector common(columns_);
  for (int a = 0; a < columns_; ++a) common[a] = dot(equations_.column(a), column, count);
  const FitSubvector others = factors.solve(common);
  const double information = dot(column, column, count) - others.dot(common);
  if (!(information > 0)) return {};
  return {(dot(column, equations_.residual(), count) - others.dot(g)) / information,
          kVarianceFactor * excess_ / information};
}

void PatternFit::assemble(const FitVector& x, const FitPrior& prior, FitSubmatrix& h, FitSubvector& g) const {
  h.resize(columns_, columns_);
  g.resize(columns_);
  for (int a = 0; a < columns_; ++a) {
    g[a] = equations_.gradient(a);
    for (int b = 0; b < columns_; ++b) {
      h(a, b) = equations_.product(a, b) + prior.information(parameter_[a], parameter_[b]);
      g[a] += prior.information(parameter_[a], parameter_[b]) * (prior.mean[parameter_[b]] - x[parameter_[b]]);
    }
  }
}

void PatternFit::solve(const FitVector& x, const FitPrior& prior, FitStep& result) {
  FitSubmatrix h;
  assemble(x, prior, h, gradient_);
  at_ = x;
  factors_.compute(h);
  result.valid = factors_.info() == Eigen::Success && factors_.vectorD().minCoeff() > 0;
  if (!result.valid) return;
  const FitSubvector change = factors_.solve(gradient_);
  result.valid = change.allFinite();
  for (int a = 0; a < columns_; ++a) result.change[parameter_[a]] = change[a];
}

FitMatrix PatternFit::covariance() const {
  return spread(factors_.solve(FitSubmatrix::Identity(columns_, columns_)));
}

FitMatrix PatternFit::spread(const FitSubmatrix& inverse) const {
  FitMatrix covariance = FitMatrix::Zero();
  for (int a = 0; a < columns_; ++a)
    for (int b = 0; b < columns_; ++b) covariance(parameter_[a], parameter_[b]) = kVarianceFactor * inverse(a, b);
  return covariance;
}

}  // namespace vibe::vision
