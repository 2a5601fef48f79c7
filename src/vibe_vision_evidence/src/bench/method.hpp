#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "bench/bench_scene.hpp"
#include "vibe_vision/synthetic/renderer.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::evidence {

/// By how much the consumer's picture is later than the frame [s].
constexpr double kLead = 14e-3;

/// What a method says about its marker in one frame.
struct Estimate {
  bool found = false;
  Doubt doubt = Doubt::None;                             ///< if found: what may be wrong
  LostReason reason = LostReason::NotFound;              ///< if not found; of the own trackers
  double along = 0;                                      ///< undistorted [px]
  double rotation = 0;                                   ///< [rad]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of along [px] and rotation [rad]; zero: not stated
};

/// One method over the frames of one scene, in their order. Times are of the thread's processor [s].
struct MethodRun {
  std::vector<Estimate> estimates;  ///< while tracking, one per frame
  std::vector<Estimate> searches;   ///< without knowledge of earlier frames; of every search_stride-th frame
  std::size_t search_stride = 1;
  std::vector<double> lead_errors;   ///< of the slide, extrapolated by kLead [m]; for methods with covariance
  std::vector<double> track_times;   ///< per frame, near the last or true position
  std::vector<double> search_times;  ///< per frame, along the axis or in the whole frame
};

class Method {
 public:
  virtual ~Method() = default;
  virtual std::string name() const = 0;
  virtual std::size_t instrument(const BenchScene& scene) const = 0;
  virtual bool givesRotation() const { return false; }
  virtual bool statesCovariance() const { return false; }
  virtual MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) = 0;
};

/// @param search_stride  every how many frames are searched, too
std::unique_ptr<Method> makeOwnMethod(bool sleeve, const TrackerPolicy& policy = {}, std::size_t search_stride = 1);
std::unique_ptr<Method> makeCentroid();
std::unique_ptr<Method> makeTagMethod(TagFamily family);
std::vector<std::unique_ptr<Method>> allMethods();

}  // namespace vibe::vision::evidence
