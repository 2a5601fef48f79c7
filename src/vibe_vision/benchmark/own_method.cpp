#include <cmath>

#include "cpu_clock.hpp"
#include "method.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe {
namespace {

Estimate toEstimate(const SlideAxis& axis, const Measurement& measurement) {
  Estimate estimate;
  estimate.found = measurement.tracked();
  if (!estimate.found) return estimate;
  estimate.along = measurement.along;
  estimate.rotation = measurement.rotation;
  const double scale = pixelsPerMetre(axis, measurement.slide);
  const Eigen::Matrix2d units = Eigen::Vector2d(scale, 1).asDiagonal();
  estimate.covariance = units * measurement.covariance * units;
  return estimate;
}

/// The tracker of this package, with a configuration of one instrument.
class OwnMethod : public Method {
 public:
  explicit OwnMethod(bool sleeve) : sleeve_(sleeve) {}
  std::string name() const override { return sleeve_ ? "sleeve" : "ring"; }
  std::size_t instrument(const BenchScene& scene) const override { return sleeve_ ? scene.sleeve : scene.ring; }
  bool givesRotation() const override { return sleeve_; }
  bool statesCovariance() const override { return true; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    VisionConfig config = scene.config;
    config.instruments = {scene.scene.instruments[instrument(scene)].nominal};
    const SlideAxis axis = config.instruments.front().axis;
    MethodRun run;
    Tracker tracker(config), searcher(config);
    for (const RenderedFrame& frame : frames) {
      double begin = threadCpuTime();
      const Measurement tracked = tracker.track(frame.frame).front();
      run.track_times.push_back(threadCpuTime() - begin);
      run.estimates.push_back(toEstimate(axis, tracked));
    }
    for (const RenderedFrame& frame : frames) {
      searcher.reset();
      const double begin = threadCpuTime();
      const Measurement found = searcher.track(frame.frame).front();
      run.search_times.push_back(threadCpuTime() - begin);
      run.searches.push_back(toEstimate(axis, found));
    }
    return run;
  }

 private:
  bool sleeve_;
};

}  // namespace

std::unique_ptr<Method> makeOwnMethod(bool sleeve) {
  return std::make_unique<OwnMethod>(sleeve);
}

std::vector<std::unique_ptr<Method>> allMethods() {
  std::vector<std::unique_ptr<Method>> methods;
  methods.push_back(makeOwnMethod(false));
  methods.push_back(makeOwnMethod(true));
  methods.push_back(makeCentroid());
  methods.push_back(makeAruco());
  methods.push_back(makeAprilTag(true));
  methods.push_back(makeAprilTag(false));
  return methods;
}

}  // namespace vibe
