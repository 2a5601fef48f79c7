#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "track/calibration_doubts.hpp"
#include "track/rod_light.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// Sums of products of columns of floats, always in the same order and without fused operations: the same bits on every
/// machine.
class NormalEquations {
 public:
  static constexpr int kMaxColumns = 16;

  explicit NormalEquations(std::size_t capacity);

  /// Begins anew with this number of columns.
  void start(int columns);
  float* column(int k) { return columns_.data() + static_cast<std::size_t>(k) * capacity_; }
  const float* column(int k) const { return columns_.data() + static_cast<std::size_t>(k) * capacity_; }
  float* residual() { return column(kMaxColumns); }
  /// @param count  rows, a multiple of kLanes
  void sum(std::size_t count);

  double product(int a, int b) const { return a < b ? products_(a, b) : products_(b, a); }
  double gradient(int a) const { return products_(a, kMaxColumns); }

 private:
  void sumGroup(int a, int b, std::size_t begin, std::size_t rows);

  std::size_t capacity_;
  int count_ = 0;
  std::vector<float> columns_;
  Eigen::Matrix<double, kMaxColumns + 1, kMaxColumns + 1> products_;
};

/// What a fit looks for: the pose, then grey values of the marker, how the light changes over it, and the response of
/// the camera. A pixel shows
///   (black + contrast * reflectance) * (1 + slope_along * (along - pose.along) + slope_lateral * (lateral - ...))
/// times the light that is known of it, in grey values that grow with the light: 255 (seen / 255)^gamma.
constexpr int kFitParameters = kPoseParameters + 5;
enum FitIndex { kBlack = kPoseParameters, kContrast, kSlopeAlong, kSlopeLateral, kGamma };
using FitVector = Eigen::Matrix<double, kFitParameters, 1>;
using FitMatrix = Eigen::Matrix<double, kFitParameters, kFitParameters>;
/// Of some of the parameters; on the stack.
using FitSubmatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kFitParameters, kFitParameters>;
using FitSubvector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kFitParameters, 1>;

MarkerPose poseOf(const FitVector& x);

/// What is known before the picture is looked at.
struct FitPrior {
  FitVector mean = FitVector::Zero();
  FitMatrix information = FitMatrix::Zero();  ///< inverse covariance
};

enum class FitScope {
  Position,  ///< along, lateral, rotation, black and contrast
  Shape,     ///< and the rest of the pose, except the blur
  All
};

struct FitOptions {
  double uncertainty = 0;  ///< of the edges' places that the fit starts from, standard deviation [px]
  FitScope scope = FitScope::All;
  bool response = false;  ///< look for gamma, too
};

/// What is known of what a fit may look for beside its parameters: standard deviations. 0 of the motion: all.
struct SideLimits {
  double light = 0;     ///< of the light at a place of a rod, relative to what it is
  MarkerMotion motion;  ///< each of its three
};

/// The result of one step, at the parameters before the step.
struct FitStep {
  FitVector change = FitVector::Zero();
  double misfit = 0;   ///< robust chi^2 per degree of freedom
  double loss = 0;     ///< mean of the biweight's loss of a pixel, 1: all are outliers
  double visible = 0;  ///< share of the information about the position along the axis that is used
  /// The same for edges that are white inside and for those that are black inside, whichever is less: what hides a
  /// marker hides both alike, another pattern has one of them elsewhere.
  double weaker_edges = 0;
  bool valid = false;  ///< the equations could be solved
};

/// Robust Gauss-Newton steps that fit a marker's pattern to pixels. A pixel's weight is the inverse of its variance
/// times Tukey's biweight.
class PatternFit {
 public:
  PatternFit(MarkerPattern& pattern, const PixelNoise& noise, std::size_t capacity);
  /// Another pattern of the same kind and size from now on.
  void usePattern(MarkerPattern& pattern) { pattern_ = &pattern; }
  void setNoise(const PixelNoise& noise) { noise_ = noise; }

  /// The pattern at x; before the functions below. pattern.prepare() must have been called nearby. No allocation.
  void evaluate(const FitVector& x, const PixelBlock& pixels);
  /// Sets black and contrast to what fits best: medians of the white and the black pixels.
  void startLevels(const PixelBlock& pixels, FitVector& x) const;
  /// One step from x. No allocation.
  FitStep step(const FitVector& x, const FitPrior& prior, const PixelBlock& pixels, const FitOptions& options);
  /// Of the parameters after the last step(), which was valid.
  FitMatrix covariance() const;
  /// The same of a rod together with what else its picture depends on; see measureMotion().
  FitMatrix covariance(const PixelBlock& pixels, const RodLight& light, const SideLimits& limits) const;
  /// How the picture of the last step() changes with its motion. @param k  0: with the length, 1: with the bend, 2:
  /// with the turn  @param by  change of it that the pattern is prepared for
  void measureMotion(int k, const PixelBlock& pixels, double by);
  /// Replaces the change of the last step(), which was valid, by that together with the light on a rod, which is
  /// changed, and the motion. @return what the motion changes by
  MarkerMotion stepWithLight(const PixelBlock& pixels, RodLight& light, const SideLimits& limits,
                             const MarkerMotion& motion, FitStep& step) const;
  /// FitStep::loss alone.
  double loss(const FitVector& x, const PixelBlock& pixels, const FitOptions& options);
  /// What the pixels of the last step(), which was valid, tell of distortions beside all that it looked for.
  /// @param unlearnt  the prior before any picture: what a bend does to the first ones, it has taught
  Distortions distortions(const FitPrior& unlearnt, const PixelBlock& pixels, const Sight& sight);
  /// What they tell, beside all that it looked for, of a step towards another pattern, whose picture is prepared: 1 is
  /// all the way.
  Distortion towards(MarkerPattern& other, const PixelBlock& pixels);
  /// Of a marker that shows the rotation: share of the information about it that the last step() used.
  double stripeSeen(const PixelBlock& pixels) const;
  /// Share of the information about the position that is in rows of the image most of which do not agree.
  /// @param down  as Sight::down
  double oddRows(const PixelBlock& pixels, const Eigen::Vector2d& down) const;
  /// The same of the length of the motion [px], after measureMotion() of it.
  Distortion stretch(const FitPrior& unlearnt, const PixelBlock& pixels);
  const PatternValues& values() const { return values_; }
  /// Learns how the light changes around a rod, from the pixels and weights of the last step.
  void learnLight(const FitVector& x, const PixelBlock& pixels, RodLight& light) const;

 private:
  static constexpr int kMotionSides = 3, kSides = RodLight::kPlaces + kMotionSides;
  /// Normal equations of the light and the motion, and what they share with those of the last step().
  struct Sides {
    Eigen::Matrix<double, kSides, kSides> left;
    Eigen::Matrix<double, kSides, 1> right;
    Eigen::Matrix<double, Eigen::Dynamic, kSides, 0, kFitParameters> common;
  };
  Sides sides(const PixelBlock& pixels, const RodLight& light, const SideLimits& limits,
              const MarkerMotion& motion) const;
  Distortion distortion(const Eigen::LDLT<FitSubmatrix>& factors, const FitSubvector& g, std::size_t count);
  std::array<Distortion, 2> oval(const Eigen::LDLT<FitSubmatrix>& factors, const FitSubvector& g,
                                 const PixelBlock& pixels, const Sight& sight);
  FitMatrix spread(const FitSubmatrix& inverse) const;
  void chooseColumns(const FitOptions& options);
  void weigh(const FitVector& x, const PixelBlock& pixels, const FitOptions& options);
  void weighPixels(const FitVector& x, const PixelBlock& pixels, const FitOptions& options);
  void fillColumns(const FitVector& x, const PixelBlock& pixels);
  void solve(const FitVector& x, const FitPrior& prior, FitStep& result);
  void assemble(const FitVector& x, const FitPrior& prior, FitSubmatrix& h, FitSubvector& g) const;

  MarkerPattern* pattern_;
  PixelNoise noise_;
  std::array<bool, kPoseParameters> observed_;
  PatternValues values_;
  std::vector<float> factor_;                               ///< square root of a pixel's weight
  std::vector<float> weight_, rest_, information_, white_;  ///< see weigh()
  std::array<std::vector<float>, kMotionSides> moved_;      ///< see measureMotion()
  std::vector<float> before_;                               ///< reflectances, likewise
  std::vector<float> lit_;                                  ///< factor_ times the light
  NormalEquations equations_;
  Eigen::LDLT<FitSubmatrix> factors_;            ///< of the last step(),
  FitSubvector gradient_;                        ///< likewise
  double excess_ = 1;                            ///< misfit of the last step(), at least 1
  FitVector at_;                                 ///< where it was
  std::array<int, kFitParameters> parameter_{};  ///< of each column
  int columns_ = 0;
  double squares_ = 0, weights_ = 0, loss_ = 0, valid_ = 0, used_ = 0, full_ = 0, used_white_ = 0, full_white_ = 0;
};

}  // namespace vibe::vision
