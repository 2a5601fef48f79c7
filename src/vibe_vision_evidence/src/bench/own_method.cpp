
#include "bench/method.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_vision/predict/predictor.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::evidence {
namespace {

Estimate toEstimate(const SlideAxis& axis, const Measurement& measurement) {
  Estimate estimate;
  estimate.found = measurement.tracked();
  estimate.reason = measurement.reason;
  if (!estimate.found) return estimate;
  estimate.doubt = measurement.doubt;
  estimate.along = measurement.along;
  estimate.rotation = measurement.rotation;
  const double scale = pixelsPerMetre(axis, measurement.slide);
  const Eigen::Matrix2d units = Eigen::Vector2d(scale, 1).asDiagonal();
  estimate.covariance = units * measurement.covariance * units;
  return estimate;
}

/// What the predictor makes of the measurements, from 0.2 s after the start and while the marker is tracked.
class LeadError {
 public:
  LeadError(const SyntheticScene& scene, std::size_t instrument) : scene_(scene), instrument_(instrument) {}

  void add(const Frame& frame, const Measurement& measurement, std::vector<double>& errors) {
    if (!measurement.tracked()) return;
    predictor_.update(frame.stamp, measurement.slide, measurement.covariance(0, 0));
    const double time = static_cast<double>(frame.sequence) / scene_.rate;
    if (time < kSettled) return;
    const double predicted = predictor_.predict(frame.stamp + kLead).mean[0];
    errors.push_back(predicted - truthAt(scene_, instrument_, time + kLead).slide);
  }

 private:
  static constexpr double kSettled = 0.2;  // [s]
  const SyntheticScene& scene_;
  std::size_t instrument_;
  Predictor predictor_{kSlidePrior};
};

/// The tracker of this package, with a configuration of one instrument.
class OwnMethod : public Method {
 public:
  OwnMethod(bool sleeve, const TrackerPolicy& policy, std::size_t search_stride)
      : sleeve_(sleeve), policy_(policy), search_stride_(search_stride) {}
  std::string name() const override { return sleeve_ ? "sleeve" : "ring"; }
  std::size_t instrument(const BenchScene& scene) const override { return sleeve_ ? scene.sleeve : scene.ring; }
  bool givesRotation() const override { return sleeve_; }
  bool statesCovariance() const override { return true; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    VisionConfig config = scene.config;
    config.instruments = {scene.scene.instruments[instrument(scene)].nominal};
    const SlideAxis axis = config.instruments.front().axis;
    MethodRun run;
    run.search_stride = search_stride_;
    Tracker tracker(config, policy_), searcher(config, policy_);
    LeadError lead(scene.scene, instrument(scene));
    for (const RenderedFrame& frame : frames) {
      const double begin = threadCpuTime();
      const Measurement tracked = tracker.track(frame.frame).front();
      run.track_times.push_back(threadCpuTime() - begin);
      run.estimates.push_back(toEstimate(axis, tracked));
      lead.add(frame.frame, tracked, run.lead_errors);
    }
    for (std::size_t i = 0; i < frames.size(); i += search_stride_) {
      searcher.reset();
      const double begin = threadCpuTime();
      const Measurement found = searcher.track(frames[i].frame).front();
      run.search_times.push_back(threadCpuTime() - begin);
      run.searches.push_back(toEstimate(axis, found));
    }
    return run;
  }

 private:
  bool sleeve_;
  TrackerPolicy policy_;
  std::size_t search_stride_;
};

}  // namespace

std::unique_ptr<Method> makeOwnMethod(bool sleeve, const TrackerPolicy& policy, std::size_t search_stride) {
  return std::make_unique<OwnMethod>(sleeve, policy, search_stride);
}

std::vector<std::unique_ptr<Method>> allMethods() {
  std::vector<std::unique_ptr<Method>> methods;
  methods.push_back(makeOwnMethod(false));
  methods.push_back(makeOwnMethod(true));
  methods.push_back(makeCentroid());
  methods.push_back(makeTagMethod(TagFamily::Aruco));
  methods.push_back(makeTagMethod(TagFamily::AprilTag));
  return methods;
}

}  // namespace vibe::vision::evidence
