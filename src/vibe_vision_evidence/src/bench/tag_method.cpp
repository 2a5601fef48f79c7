#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/method.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_vision/image/camera_model.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision::evidence {
namespace {

constexpr std::size_t kFramesPerSearch = 20;

struct Window {
  ImageView view;
  Eigen::Vector2d corner;  ///< upper left pixel in the full image
};

Window wholeFrame(const Frame& frame) {
  return {frame.image, Eigen::Vector2d(frame.offset_x, frame.offset_y)};
}

/// Square around a pixel, cut off at the borders of the frame.
Window windowAround(const Frame& frame, const Eigen::Vector2d& centre, double half) {
  const auto clamped = [](double value, int size) { return std::clamp(static_cast<int>(std::lround(value)), 0, size); };
  const Eigen::Vector2d local = centre - Eigen::Vector2d(frame.offset_x, frame.offset_y);
  const int x0 = clamped(local.x() - half, frame.image.width), x1 = clamped(local.x() + half, frame.image.width);
  const int y0 = clamped(local.y() - half, frame.image.height), y1 = clamped(local.y() + half, frame.image.height);
  Window window;
  window.view = {frame.image.row(y0) + x0, x1 - x0, y1 - y0, frame.image.stride};
  window.corner = {frame.offset_x + x0, frame.offset_y + y0};
  return window;
}

Eigen::Vector2d centreOf(const CameraModel& camera, const TagCorners& corners, const Eigen::Vector2d& shift) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : corners) centre += undistort(camera, point + shift) / 4;
  return centre;
}

Estimate nearestTag(const CameraModel& camera, const SlideAxis& axis, const Eigen::Vector2d& shift,
                    const std::vector<TagCorners>& tags) {
  Estimate estimate;
  double nearest = std::numeric_limits<double>::infinity();
  for (const TagCorners& corners : tags) {
    const Eigen::Vector2d offset = centreOf(camera, corners, shift) - axis.origin;
    const double along = axis.direction.dot(offset), distance = (offset - along * axis.direction).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    estimate.found = true;
    estimate.along = along;
  }
  return estimate;
}

/// A library's detector as it comes; `TagReader` says how it is set up. It looks at a window around the true place
/// (which favours the tag: no prediction, no wrong window) for accuracy, and at every few whole frames for the time and
/// success of a search. Of several tags with one number the one next to the axis counts, as an application would do
/// that knows the axis.
class TagMethod : public Method {
 public:
  explicit TagMethod(TagFamily family) : family_(family) {}

  std::string name() const override { return tagFamilyName(family_); }
  std::size_t instrument(const BenchScene& scene) const override {
    return family_ == TagFamily::AprilTag ? scene.apriltag : scene.aruco;
  }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    const SyntheticInstrument& tag = scene.scene.instruments[instrument(scene)];
    const SlideAxis& axis = tag.nominal.axis;
    TagReader reader(std::get<TagDesign>(tag.nominal.marker), axis.pixels_per_metre);
    // the tag, its white border, and as much again for the text-book margin of a prediction
    const double half = 1.25 * tag.tag.side * axis.pixels_per_metre;
    MethodRun run;
    run.search_stride = kFramesPerSearch;
    const auto detect = [&](const Window& window, std::vector<Estimate>& estimates, std::vector<double>& times) {
      const double begin = threadCpuTime();
      const std::vector<TagCorners> tags =
          window.view.width > 8 && window.view.height > 8 ? reader.find(window.view) : std::vector<TagCorners>();
      times.push_back(threadCpuTime() - begin);
      estimates.push_back(nearestTag(scene.scene.camera, axis, window.corner, tags));
    };
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Frame& frame = frames[i].frame;
      const SyntheticTruth& truth = frames[i].truth[instrument(scene)];
      const double motion = std::abs(truth.velocity) * scene.scene.degradation.exposure;
      detect(windowAround(frame, truth.pixel, half + motion / 2), run.estimates, run.track_times);
      if (i % kFramesPerSearch == 0) detect(wholeFrame(frame), run.searches, run.search_times);
    }
    return run;
  }

 private:
  TagFamily family_;
};

}  // namespace

std::unique_ptr<Method> makeTagMethod(TagFamily family) {
  return std::make_unique<TagMethod>(family);
}

}  // namespace vibe::vision::evidence
