#include "vibe_vision/tag/tag_reader.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/aruco.hpp>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

namespace vibe::vision {

namespace {

#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR < 407
cv::Ptr<cv::aruco::Dictionary> arucoDictionary() {
  return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
}
cv::Ptr<cv::aruco::DetectorParameters> arucoParameters() {
  return cv::aruco::DetectorParameters::create();
}
void drawAruco(int id, int side, cv::Mat& picture) {
  arucoDictionary()->drawMarker(id, side, picture, 1);
}
#else
cv::Ptr<cv::aruco::Dictionary> arucoDictionary() {
  return cv::makePtr<cv::aruco::Dictionary>(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50));
}
cv::Ptr<cv::aruco::DetectorParameters> arucoParameters() {
  return cv::makePtr<cv::aruco::DetectorParameters>();
}
void drawAruco(int id, int side, cv::Mat& picture) {
  arucoDictionary()->generateImageMarker(id, side, picture, 1);
}
#endif

std::vector<std::uint8_t> aprilTagPicture(int id) {
  apriltag_family_t* family = tag36h11_create();
  const apriltag_family_t& f = *family;
  const auto cells = static_cast<std::size_t>(f.width_at_border);
  std::vector<std::uint8_t> white(cells * cells, 0);
  for (std::uint32_t i = 0; i < f.nbits; ++i)  // as apriltag_to_image() does
    if ((f.codes[id] >> (f.nbits - 1 - i)) & 1) white[f.bit_y[i] * cells + f.bit_x[i]] = 1;
  tag36h11_destroy(family);
  return white;
}

std::vector<std::uint8_t> arucoPicture(int id, int cells) {
  cv::Mat picture;
  drawAruco(id, cells, picture);
  std::vector<std::uint8_t> white;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) white.push_back(picture.at<std::uint8_t>(y, x) > 127 ? 1 : 0);
  return white;
}

}  // namespace

std::vector<std::uint8_t> tagPicture(const TagDesign& tag) {
  return tag.family == TagFamily::AprilTag ? aprilTagPicture(tag.id) : arucoPicture(tag.id, tagCells(tag.family));
}

class TagReader::Detector {
 public:
  virtual ~Detector() = default;
  virtual std::vector<TagCorners> find(const ImageView& view) = 0;
};

class TagReader::AprilTagDetector : public Detector {
 public:
  explicit AprilTagDetector(int id) : id_(id) {
    detector_->nthreads = 1;
    detector_->quad_decimate = 1;
    detector_->refine_edges = true;
    apriltag_detector_add_family(detector_, family_);
  }
  ~AprilTagDetector() override {
    apriltag_detector_destroy(detector_);
    tag36h11_destroy(family_);
  }
  AprilTagDetector(const AprilTagDetector&) = delete;
  AprilTagDetector& operator=(const AprilTagDetector&) = delete;

  std::vector<TagCorners> find(const ImageView& view) override {
    image_u8_t image = {view.width, view.height, view.stride, const_cast<std::uint8_t*>(view.data)};
    zarray_t* detections = apriltag_detector_detect(detector_, &image);
    std::vector<TagCorners> tags;
    for (int i = 0; i < zarray_size(detections); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections, i, &detection);
      if (detection->id != id_) continue;
      // the library's pixel centres are at +0.5
      tags.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) tags.back()[k] = {detection->p[k][0] - 0.5, detection->p[k][1] - 0.5};
    }
    apriltag_detections_destroy(detections);
    return tags;
  }

 private:
  int id_;
  apriltag_family_t* family_ = tag36h11_create();
  apriltag_detector_t* detector_ = apriltag_detector_create();
};

class TagReader::ArucoDetector : public Detector {
 public:
  /// @param cell  of the tag [px]
  ArucoDetector(int id, double cell) : id_(id) {
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    parameters_->cornerRefinementWinSize = std::max(1, static_cast<int>(cell / 2));
  }

  std::vector<TagCorners> find(const ImageView& view) override {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(view.mat(), dictionary_, corners, ids, parameters_);
    std::vector<TagCorners> tags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != id_) continue;
      tags.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) tags.back()[k] = {corners[i][k].x, corners[i][k].y};
    }
    return tags;
  }

 private:
  int id_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_ = arucoDictionary();
  cv::Ptr<cv::aruco::DetectorParameters> parameters_ = arucoParameters();
};

TagReader::TagReader(const TagDesign& tag, double pixels_per_metre) {
  if (tag.family == TagFamily::AprilTag)
    detector_ = std::make_unique<AprilTagDetector>(tag.id);
  else
    detector_ = std::make_unique<ArucoDetector>(tag.id, tag.side * pixels_per_metre / tagCells(tag.family));
}

TagReader::~TagReader() = default;
TagReader::TagReader(TagReader&&) noexcept = default;
TagReader& TagReader::operator=(TagReader&&) noexcept = default;

std::vector<TagCorners> TagReader::find(const ImageView& view) {
  constexpr int kLeast = 8;  // the detectors do not look at less [px]
  if (view.width <= kLeast || view.height <= kLeast) return {};
  return detector_->find(view);
}

TagPlace TagPlace::of(const CameraModel& camera, const TagCorners& corners, const Eigen::Vector2d& shift, double side) {
  std::array<Eigen::Vector2d, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = undistort(camera, corners[i] + shift);
  const auto u = [&] { return Eigen::Vector2d((p[1] + p[2] - p[0] - p[3]) / (2 * side)); };
  const auto v = [&] { return Eigen::Vector2d((p[2] + p[3] - p[0] - p[1]) / (2 * side)); };
  TagPlace place;
  place.picture << u(), v();
  if (place.picture.determinant() < 0) {  // corners the other way round
    std::swap(p[1], p[3]);
    place.picture << u(), v();
  }
  place.centre = (p[0] + p[1] + p[2] + p[3]) / 4;
  place.pixels_per_metre = std::sqrt(std::abs(place.picture.determinant()));
  place.misfit = ((p[0] - p[1] + p[2] - p[3]) / 4).norm();
  return place;
}

}  // namespace vibe::vision
