#pragma once

#include <functional>
#include <memory>

#include "track/axis_map.hpp"
#include "track/pattern_fit.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// A marker as it was fitted to one frame.
struct MarkerFit {
  FitVector x = FitVector::Zero();
  FitMatrix covariance = FitMatrix::Zero();
  double misfit = 0;        ///< robust chi^2 per degree of freedom
  double loss = 0;          ///< mean of the robust loss of a pixel
  double visible = 0;       ///< share of the information about the position that was used
  double weaker_edges = 0;  ///< see FitStep
  double stripe_seen = 1;   ///< the same of the information about the rotation, of a marker that shows it
  bool shows_turn = true;   ///< false: the rotation is what was known before
  MarkerMotion motion;      ///< as assumed
  bool valid = false;       ///< the fit converged
  double clipped = 0;       ///< share of the pixels that are as bright as a pixel can be
  cv::Rect roi;             ///< pixels of the full sensor that were looked at
};

/// What MarkerFitter::acquire() begins from.
struct Candidate {
  FitVector start;
  FitPrior prior;
  double motion = 0;            ///< during the exposure, as the search has seen it [px]
  MarkerMotion most;            ///< that the instrument can do
  bool known_rotation = false;  ///< start.rotation is a prediction
  double reach = 0;             ///< from the start, within which the marker is [px]; 0: the search knows it well
};

/// Reads the pixels around a place and fits a marker's pattern to them.
class MarkerFitter {
 public:
  using MakePattern = std::function<std::unique_ptr<MarkerPattern>(double ink)>;  ///< [m]
  /// @param ink  of the print, as far as it is known [m]
  /// @param rod_radius  of a sleeve at log_scale 0 [px]; 0 for a flat marker
  MarkerFitter(MakePattern make, double ink, const PixelNoise& noise, double rod_radius);

  const MarkerPattern& pattern() const { return *pattern_; }
  bool shows(PoseIndex k) const { return observed_[k]; }
  void setNoise(const PixelNoise& noise) { fit_.setNoise(noise); }
  double ink() const { return ink_; }  ///< by which black reaches beyond the designed edges [m]
  /// Takes what the last fit, of follow(), tells of the ink, if that is clear. It costs tens of milliseconds and memory
  /// then. @return false if the ink stays as it was
  bool learnInk(const MarkerFit& fit, const FitPrior& prior);
  /// Forgets the light on the rod.
  void forget();

  /// From a good prediction. @param uncertainty  of its position, standard deviation [px]
  /// @param known_rotation  start.rotation is a prediction
  MarkerFit follow(AxisMap& map, const Frame& frame, const FitVector& start, const FitPrior& prior,
                   const MarkerMotion& motion, double uncertainty, bool known_rotation = true);
  /// The last fit again, from the bars alone. @param prior  tells the rotation
  void leaveStripe(MarkerFit& fit, const FitPrior& prior);
  /// Whether acquire() looks at the stripe of a sleeve; else the prior tells the rotation.
  void useStripe(bool use) { stripe_ = use; }
  /// The last fit again, with what it told of the motion.
  void repeat(MarkerFit& fit, const FitPrior& prior, const MarkerMotion& motion);
  /// By how much longer the motion during the exposure was than the last fit assumed [px].
  Distortion stretch(const MarkerFit& fit, const FitPrior& unlearnt);
  /// Of the picture in the last fit, see PatternFit.
  double oddRows(const Sight& sight) const { return fit_.oddRows(pixels_, sight.down); }
  /// Of the picture in the last fit, which was valid. @param unlearnt  the prior before any picture
  Distortions distortions(const FitPrior& unlearnt, const Sight& sight) {
    return fit_.distortions(unlearnt, pixels_, sight);
  }
  /// From a candidate of the search: from coarse to fine, with any rotation.
  MarkerFit acquire(AxisMap& map, const Frame& frame, const Candidate& candidate);

 private:
  static constexpr double kStrangeMotion = 1.5;  ///< misfit from which a motion may be why
  static constexpr double kLearnVisible = 0.8;   ///< share of a rod that must be seen to learn the light on it

  bool read(AxisMap& map, const Frame& frame, MarkerFit& fit, bool guess_light = false);
  void linearise();
  void hideStripe();
  void prepare(const MarkerFit& fit, bool rough = false);
  void useGamma(double gamma);
  MarkerFit acquireWithAnyResponse(AxisMap& map, const Frame& frame, const Candidate& candidate);
  void setInk(double ink);
  MarkerFit acquireWithInk(AxisMap& map, const Frame& frame, const Candidate& candidate, const MarkerFit& first);
  MarkerFit tryToAcquire(AxisMap& map, const Frame& frame, const Candidate& candidate);
  void refineWithLight(MarkerFit& fit, const FitPrior& prior);
  SideLimits sideLimits(const MarkerFit& fit) const;
  void stepWithSides(MarkerFit& fit, FitStep& step);
  void measureMotion(const MarkerFit& fit, const SideLimits& limits);
  void usePixels(std::size_t one_of);
  bool align(MarkerFit& fit, const FitPrior& prior, FitScope scope);
  void choosePlace(MarkerFit& fit, double reach);
  void choose(PoseIndex k, const std::vector<double>& values, MarkerFit& fit);
  void chooseMotion(MarkerFit& fit, const FitPrior& prior);
  static bool isMotionLong(const MarkerFit& fit);
  void refineMotion(MarkerFit& fit, const FitPrior& prior, double max_motion);
  bool tryMotions(MarkerFit& fit, const FitPrior& prior, double distance);
  void refine(MarkerFit& fit, const FitPrior& prior, double uncertainty, int max_steps);
  double lengthOf(const FitStep& step) const;
  void stateCovariance(MarkerFit& fit) const;
  void doubtLight(MarkerFit& fit);
  static void doubtCovered(MarkerFit& fit);
  void take(const FitStep& step, MarkerFit& fit);

  MakePattern make_;
  double ink_;
  std::unique_ptr<MarkerPattern> pattern_, inked_;  ///< with more ink
  std::array<bool, kPoseParameters> observed_;
  std::vector<double> rotations_;
  double radius_;  ///< of the marker, about [px]
  PixelBlock pixels_;
  std::size_t all_ = 0;  ///< pixels read
  RodLight light_;
  SideLimits sides_;                 ///< in refine(); light 0: nothing beside the parameters
  int lit_frames_ = 0;               ///< followed since forget(), the light of which was learnt
  int tries_ = 0;                    ///< by acquire() since the light was learnt
  int ink_tries_ = 0;                ///< likewise for the ink
  bool ink_known_ = false;           ///< a frame that was followed fitted: a print stays as it is
  bool stripe_ = true;               ///< see useStripe()
  double gamma_ = 1;                 ///< of pixels_ and light_
  double table_gamma_ = 0;           ///< of linear_
  std::array<float, 256> linear_{};  ///< grey values
  double seen_ = 0;                  ///< share of the marker that follow() saw the last time
  MarkerPose prepared_;              ///< for which the pattern made its picture,
  MarkerMotion prepared_motion_;
  bool prepared_rough_ = false, is_prepared_ = false;
  MarkerMotion most_;  ///< in acquire()
  PatternFit fit_;
};

}  // namespace vibe::vision
