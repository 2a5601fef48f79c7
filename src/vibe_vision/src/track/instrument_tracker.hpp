#pragma once
#include "track/axis_search.hpp"
#include "track/gates.hpp"
#include "track/kalman_filters.hpp"
#include "track/marker_fitter.hpp"
#include "track/outcome.hpp"
#include "track/slow_state.hpp"

namespace vibe::vision {

/// Follows one instrument. Each frame: predict, fit, gate; if that fails, search the axis, fit and gate again.
class InstrumentTracker : public MarkerTracker {
 public:
  InstrumentTracker(const VisionConfig& config, const InstrumentConfig& instrument, const TrackerPolicy& policy);

  const Measurement& track(const Frame& frame) override;
  const Measurement& lose(LostReason reason) override;
  void reset() override;
  void setNoise(const PixelNoise& noise) override { fitter_.setNoise(noise); }
  double ink() const override { return fitter_.ink(); }

 private:
  struct Prediction {
    MotionFilter::State slide, rotation;
    double dt = 0;       ///< since the last measurement [s]
    bool known = false;  ///< something was seen before
    bool close = false;  ///< well enough to fit right away
    bool turn = false;   ///< the rotation is known well enough to fit from it
  };
  Prediction predict(double stamp);
  MarkerMotion motionAt(const MotionFilter::State& slide, const MotionFilter::State& rotation, double exposure) const;
  FitVector startAt(double slide, const FitPrior& prior, const Prediction& prediction) const;
  bool follow(const Frame& frame, const Prediction& prediction);
  void lookForCopies(const Frame& frame);
  bool leaveCopy(const Frame& frame);
  void rememberCopies(const Frame& frame, const AxisSearch::Result& found, double from, double to, double own);
  MarkerFit bestOf(const Frame& frame, const Prediction& prediction, const AxisSearch::Result& found, bool& is_last);
  bool consider(const MarkerFit& fit, const Prediction& prediction, MarkerFit& best);
  void lookForDistortions(const Frame& frame, const MarkerFit& fit);
  FitPrior withTurn(const FitPrior& prior, const Prediction& prediction) const;
  void checkStripe(const FitPrior& prior, const Prediction& prediction, MarkerFit& fit);
  Sight sightAt(const MarkerFit& fit) const;
  void stateDoubts(const Frame& frame);
  void correctMotion(const Frame& frame, const FitPrior& prior, MarkerFit& fit);
  bool search(const Frame& frame, const Prediction& prediction);
  bool searchNearby(const Frame& frame, const Prediction& prediction);
  MarkerMotion fastestMotion(const Frame& frame) const;
  bool searchRange(const Frame& frame, const Prediction& prediction, double begin, double end);
  void learnInk(const MarkerFit& fit, const FitPrior& prior);
  MarkerFit tryCandidate(const Frame& frame, const Prediction& prediction, const AxisSearch::Candidate& candidate);
  MarkerFit tryBars(const Frame& frame, const Prediction& prediction, const AxisSearch::Candidate& candidate);
  FitPrior searchPrior(double slide) const;
  bool isPart(const MarkerFit& fit) const;
  bool isNear(const MarkerFit& fit, const Prediction& prediction) const;
  bool isExpectedPart(const MarkerFit& fit, const Prediction& prediction) const;
  bool isWithin(double place, const MarkerFit& fit, const Prediction& prediction) const;
  bool isExpected(const MarkerFit& fit, const Prediction& prediction, double stamp);
  void accept(const Frame& frame, const MarkerFit& fit, const Prediction& prediction, bool reacquired);
  void toMiddle(const Frame& frame, const MarkerFit& fit, double scale);
  void describe(const MarkerFit& fit);
  void updateFilters(double stamp, const MarkerFit& fit, double scale, bool restart);

  MarkerView view_;
  double min_contrast_;
  MarkerFitter fitter_;
  AxisMap map_;
  AxisSearch search_;
  Gates gates_;
  Copies copies_;
  SlowState slow_;
  const SlowState unknown_;  ///< at the beginning, always
  LightModel light_;
  int looks_ = 0;     ///< moving frames
  int followed_ = 0;  ///< frames
  MotionFilter rotation_;
  double last_rotation_ = 0;
  bool stripe_ = true;   ///< the rotation was seen, of a marker that shows it
  bool broken_ = false;  ///< the motion is not the one of the frames before
  double odd_rows_ = 0;  ///< share of the last picture, see PatternFit
  double looked_ = 0;    ///< for copies, from the beginning of the axis up to here [px]
  int looks_for_copies_ = 0, doubted_frames_ = 0;
  int tries_ = 0;        ///< candidates of this frame
  int lost_frames_ = 1;  ///< there is none at first
};

}  // namespace vibe::vision
