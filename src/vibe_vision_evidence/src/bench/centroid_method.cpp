#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "bench/method.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_vision/image/camera_model.hpp"

namespace vibe::vision::evidence {
namespace {

/// The usual simple tracker of a printed mark: threshold half way between the darkest and the brightest pixel,
/// connected components, gates for size and for touching the border, then the centroid weighted by darkness. It looks
/// around the last position, extrapolated, and where that fails along the whole axis in the same frame.
class Centroid {
 public:
  Centroid(const BenchScene& scene)
      : camera_(scene.scene.camera), instrument_(scene.scene.instruments[scene.ring].nominal) {
    const RingDesign& ring = std::get<RingDesign>(instrument_.marker);
    const double scale = instrument_.axis.pixels_per_metre;
    half_ = 0.5 * ring.side * scale + 10;
    diameter_ = ring.outer_diameter * scale;
    area_ = M_PI / 4 * scale * scale *
            (ring.outer_diameter * ring.outer_diameter - ring.inner_diameter * ring.inner_diameter);
  }

  void reset() { known_ = 0; }

  Estimate track(const Frame& frame) {
    std::optional<Eigen::Vector2d> centre;
    if (known_ > 0) centre = search(frame, windowAround(frame, expected()));
    if (!centre) centre = search(frame, axisBand(frame));
    if (!centre) {
      known_ = 0;
      return {};
    }
    before_ = last_;
    last_ = *centre;
    ++known_;
    Estimate estimate;
    estimate.found = true;
    estimate.along = instrument_.axis.direction.dot(undistort(camera_, *centre) - instrument_.axis.origin);
    return estimate;
  }

 private:
  Eigen::Vector2d expected() const { return known_ > 1 ? Eigen::Vector2d(2 * last_ - before_) : last_; }

  static cv::Rect cut(const Frame& frame, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const cv::Point first(static_cast<int>(std::lround(low.x())) - frame.offset_x,
                          static_cast<int>(std::lround(low.y())) - frame.offset_y);
    const cv::Point last(static_cast<int>(std::lround(high.x())) - frame.offset_x,
                         static_cast<int>(std::lround(high.y())) - frame.offset_y);
    return cv::Rect(first, last) & cv::Rect(0, 0, frame.image.width, frame.image.height);
  }

  cv::Rect windowAround(const Frame& frame, const Eigen::Vector2d& centre) const {
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(half_);
    return cut(frame, centre - half, centre + half);
  }

  cv::Rect axisBand(const Frame& frame) const {
    const SlideAxis& axis = instrument_.axis;
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(half_);
    const Eigen::Vector2d a = distort(camera_, pixelAt(axis, alongOf(axis, instrument_.lower)));
    const Eigen::Vector2d b = distort(camera_, pixelAt(axis, alongOf(axis, instrument_.upper)));
    return cut(frame, a.cwiseMin(b) - half, a.cwiseMax(b) + half);
  }

  /// The component whose area is next to the ring's, within limits, inside the window.
  std::optional<Eigen::Vector2d> search(const Frame& frame, const cv::Rect& window) {
    if (window.width < 8 || window.height < 8) return std::nullopt;
    const cv::Mat part = frame.image.mat()(window);
    double darkest = 0, brightest = 0;
    cv::minMaxLoc(part, &darkest, &brightest);
    if (brightest - darkest < 40) return std::nullopt;
    const double middle = (darkest + brightest) / 2;
    cv::threshold(part, mask_, middle, 255, cv::THRESH_BINARY_INV);
    const int count = cv::connectedComponentsWithStats(mask_, labels_, statistics_, centroids_, 8, CV_32S);
    int best = 0;
    for (int i = 1; i < count; ++i)
      if (acceptable(i, window) && (best == 0 || misfit(i) < misfit(best))) best = i;
    if (best == 0) return std::nullopt;
    const cv::Rect box = boxOf(best, 3) & cv::Rect(0, 0, window.width, window.height);
    return weighted(part(box), middle) +
           Eigen::Vector2d(window.x + box.x + frame.offset_x, window.y + box.y + frame.offset_y);
  }

  cv::Rect boxOf(int component, int margin) const {
    const auto entry = [&](int column) { return statistics_.at<int>(component, column); };
    return {entry(cv::CC_STAT_LEFT) - margin, entry(cv::CC_STAT_TOP) - margin, entry(cv::CC_STAT_WIDTH) + 2 * margin,
            entry(cv::CC_STAT_HEIGHT) + 2 * margin};
  }

  double misfit(int component) const {
    return std::abs(std::log(statistics_.at<int>(component, cv::CC_STAT_AREA) / area_));
  }

  bool acceptable(int component, const cv::Rect& window) const {
    const cv::Rect box = boxOf(component, 0);
    const bool inside =
        box.x > 0 && box.y > 0 && box.x + box.width < window.width && box.y + box.height < window.height;
    const double across = std::min(box.width, box.height) / diameter_;
    return inside && misfit(component) < std::log(1.5) && across > 0.75 && across < 1.3;
  }

  static Eigen::Vector2d weighted(const cv::Mat& part, double middle) {
    cv::Mat white_mask = part > middle;
    const double white = cv::mean(part, white_mask)[0];
    double sum = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (int y = 0; y < part.rows; ++y)
      for (int x = 0; x < part.cols; ++x) {
        const double weight = std::max(0.0, white - part.at<std::uint8_t>(y, x));
        sum += weight;
        moment += weight * Eigen::Vector2d(x, y);
      }
    return moment / std::max(sum, 1e-9);
  }

  CameraModel camera_;
  InstrumentConfig instrument_;
  double half_ = 0, diameter_ = 0, area_ = 0;
  int known_ = 0;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero(), before_ = Eigen::Vector2d::Zero();
  cv::Mat mask_, labels_, statistics_, centroids_;
};

class CentroidMethod : public Method {
 public:
  std::string name() const override { return "centroid"; }
  std::size_t instrument(const BenchScene& scene) const override { return scene.ring; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    MethodRun run;
    Centroid centroid(scene);
    const auto timed = [&](const Frame& frame, std::vector<Estimate>& estimates, std::vector<double>& times) {
      const double begin = threadCpuTime();
      estimates.push_back(centroid.track(frame));
      times.push_back(threadCpuTime() - begin);
    };
    for (const RenderedFrame& frame : frames) timed(frame.frame, run.estimates, run.track_times);
    for (const RenderedFrame& frame : frames) {
      centroid.reset();
      timed(frame.frame, run.searches, run.search_times);
    }
    return run;
  }
};

}  // namespace

std::unique_ptr<Method> makeCentroid() {
  return std::make_unique<CentroidMethod>();
}

}  // namespace vibe::vision::evidence
