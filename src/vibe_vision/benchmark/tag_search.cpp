#include "tag_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <opencv2/aruco.hpp>

#include "method.hpp"
#include "vibe_core/common/step_timer.hpp"
#include "vibe_vision/image/camera_model.hpp"

namespace vibe::vision {

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

Eigen::Vector2d centreOf(const CameraModel& camera, const Corners& corners, const Eigen::Vector2d& shift) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : corners) centre += undistort(camera, point + shift) / 4;
  return centre;
}

Estimate nearestTag(const CameraModel& camera, const SlideAxis& axis, const Eigen::Vector2d& shift,
                    const std::vector<Corners>& tags) {
  Estimate estimate;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Corners& corners : tags) {
    const Eigen::Vector2d offset = centreOf(camera, corners, shift) - axis.origin;
    const double along = axis.direction.dot(offset), distance = (offset - along * axis.direction).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    estimate.found = true;
    estimate.along = along;
  }
  return estimate;
}

}  // namespace

MethodRun runTagDetector(const BenchScene& scene, std::size_t instrument, const std::vector<RenderedFrame>& frames,
                         const TagDetector& detector) {
  const SyntheticInstrument& tag = scene.scene.instruments[instrument];
  const SlideAxis& axis = tag.nominal.axis;
  // the tag, its white border, and as much again for the text-book margin of a prediction
  const double half = 1.25 * tag.tag.side * axis.pixels_per_metre;
  MethodRun run;
  run.search_stride = kFramesPerSearch;
  const auto detect = [&](const Window& window, std::vector<Estimate>& estimates, std::vector<double>& times) {
    const double begin = threadCpuTime();
    const std::vector<Corners> tags =
        window.view.width > 8 && window.view.height > 8 ? detector(window.view) : std::vector<Corners>();
    times.push_back(threadCpuTime() - begin);
    estimates.push_back(nearestTag(scene.scene.camera, axis, window.corner, tags));
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i].frame;
    const double motion = std::abs(frames[i].truth[instrument].velocity) * scene.scene.degradation.exposure;
    const Window window = windowAround(frame, frames[i].truth[instrument].pixel, half + motion / 2);
    detect(window, run.estimates, run.track_times);
    if (i % kFramesPerSearch == 0) detect(wholeFrame(frame), run.searches, run.search_times);
  }
  return run;
}

namespace {

constexpr int kBits = 4;

#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR < 407
cv::Ptr<cv::aruco::Dictionary> dictionary() {
  return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
}
cv::Ptr<cv::aruco::DetectorParameters> defaultParameters() {
  return cv::aruco::DetectorParameters::create();
}
void drawMarker(int id, int side, cv::Mat& picture) {
  dictionary()->drawMarker(id, side, picture, 1);
}
#else
cv::Ptr<cv::aruco::Dictionary> dictionary() {
  return cv::makePtr<cv::aruco::Dictionary>(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
}
cv::Ptr<cv::aruco::DetectorParameters> defaultParameters() {
  return cv::makePtr<cv::aruco::DetectorParameters>();
}
void drawMarker(int id, int side, cv::Mat& picture) {
  dictionary()->generateImageMarker(id, side, picture, 1);
}
#endif

/// cv::aruco with CORNER_REFINE_SUBPIX, otherwise as it comes. The window of the refinement stays within one cell: a
/// larger one finds corners of the cells inside.
class ArucoMethod : public Method {
 public:
  std::string name() const override { return "aruco"; }
  std::size_t instrument(const BenchScene& scene) const override { return scene.aruco; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    const SyntheticInstrument& tag = scene.scene.instruments[scene.aruco];
    const double cell = tag.tag.side * tag.nominal.axis.pixels_per_metre / tag.tag.cells;
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    parameters_->cornerRefinementWinSize = std::max(1, static_cast<int>(cell / 2));
    return runTagDetector(scene, scene.aruco, frames, [this](const ImageView& view) { return detect(view); });
  }

 private:
  std::vector<Corners> detect(const ImageView& view) {
    const cv::Mat image(view.height, view.width, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                        static_cast<std::size_t>(view.stride));
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(image, dictionary_, corners, ids, parameters_);
    std::vector<Corners> tags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != kArucoId) continue;
      tags.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) tags.back()[k] = {corners[i][k].x, corners[i][k].y};
    }
    return tags;
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary_ = dictionary();
  cv::Ptr<cv::aruco::DetectorParameters> parameters_ = defaultParameters();
};

}  // namespace

SyntheticTag arucoTag(double side) {
  cv::Mat picture;
  drawMarker(kArucoId, kBits + 2, picture);
  SyntheticTag tag;
  tag.cells = kBits + 2;
  tag.side = side;
  for (int y = 0; y < tag.cells; ++y)
    for (int x = 0; x < tag.cells; ++x) tag.white.push_back(picture.at<std::uint8_t>(y, x) > 127 ? 1 : 0);
  return tag;
}

std::unique_ptr<Method> makeAruco() {
  return std::make_unique<ArucoMethod>();
}

namespace {

struct Family {
  apriltag_family_t* family = tag36h11_create();
  ~Family() { tag36h11_destroy(family); }
};

/// libapriltag, one thread, without decimation.
class AprilTagMethod : public Method {
 public:
  explicit AprilTagMethod(bool refine_edges) : refine_edges_(refine_edges) {
    detector_->nthreads = 1;
    detector_->quad_decimate = 1;
    detector_->refine_edges = refine_edges;
    apriltag_detector_add_family(detector_, family_.family);
  }
  ~AprilTagMethod() override { apriltag_detector_destroy(detector_); }
  AprilTagMethod(const AprilTagMethod&) = delete;
  AprilTagMethod& operator=(const AprilTagMethod&) = delete;

  std::string name() const override { return refine_edges_ ? "apriltag" : "apriltag_unrefined"; }
  std::size_t instrument(const BenchScene& scene) const override { return scene.apriltag; }

  MethodRun run(const BenchScene& scene, const std::vector<RenderedFrame>& frames) override {
    return runTagDetector(scene, scene.apriltag, frames, [this](const ImageView& view) { return detect(view); });
  }

 private:
  std::vector<Corners> detect(const ImageView& view) {
    image_u8_t image = {view.width, view.height, view.stride, const_cast<std::uint8_t*>(view.data)};
    zarray_t* detections = apriltag_detector_detect(detector_, &image);
    std::vector<Corners> tags;
    for (int i = 0; i < zarray_size(detections); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections, i, &detection);
      if (detection->id != kAprilTagId) continue;
      // the library's pixel centres are at +0.5
      tags.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) tags.back()[k] = {detection->p[k][0] - 0.5, detection->p[k][1] - 0.5};
    }
    apriltag_detections_destroy(detections);
    return tags;
  }

  bool refine_edges_;
  Family family_;
  apriltag_detector_t* detector_ = apriltag_detector_create();
};

}  // namespace

SyntheticTag aprilTag(double side) {
  const Family family;
  const apriltag_family_t& f = *family.family;
  const auto cells = static_cast<std::size_t>(f.width_at_border);
  SyntheticTag tag;
  tag.cells = f.width_at_border;
  tag.side = side;
  tag.white.assign(cells * cells, 0);
  for (std::uint32_t i = 0; i < f.nbits; ++i)  // as apriltag_to_image() does
    if ((f.codes[kAprilTagId] >> (f.nbits - 1 - i)) & 1) tag.white[f.bit_y[i] * cells + f.bit_x[i]] = 1;
  return tag;
}

std::unique_ptr<Method> makeAprilTag(bool refine_edges) {
  return std::make_unique<AprilTagMethod>(refine_edges);
}

}  // namespace vibe::vision
