#include "vibe_vision/calibrate/marker_finder.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

constexpr double kMinScore = 0.6;        // correlation of what is taken for the marker
constexpr std::ptrdiff_t kPerScale = 3;  // places of a size that are looked at closely
constexpr double kSamePlace = 10;        // [px]
constexpr double kScaleStep = 1.06;
constexpr double kAngleStep = 10 * M_PI / 180;
constexpr double kSeenWidth = 0.7;  // share of a sleeve's width that is seen without much foreshortening
constexpr int kSamples = 4;         // per pixel and direction

/// Picture of a marker with u to the right, as the camera would see it: 0 to 255.
cv::Mat pictureOf(const RingDesign& ring, double scale) {
  const int size = std::max(5, static_cast<int>(std::floor(ring.side * scale)) | 1);
  cv::Mat picture(size, size, CV_8U);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      double sum = 0;
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const double dx = (i % kSamples + 0.5) / kSamples - 0.5, dy = (i / kSamples + 0.5) / kSamples - 0.5;
        sum += reflectance(ring, (x - size / 2 + dx) / scale, (y - size / 2 + dy) / scale);
      }
      picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(255 * sum / (kSamples * kSamples)));
    }
  }
  return picture;
}

/// The stripe is grey: its phase is not known.
cv::Mat pictureOf(const TagDesign&, double) {
  throw Error("a tag of another library is read, not correlated with its picture; use locateMarkers()");
}

double meanReflectance(const SleeveDesign& sleeve, double u) {
  if (u > sleeve.helix_begin && u < sleeve.helix_end) return 1 - sleeve.helix_duty;
  return reflectance(sleeve, u, 0);
}

cv::Mat pictureOf(const SleeveDesign& sleeve, double scale) {
  const int width = std::max(5, static_cast<int>(std::floor(sleeve.length * scale)) | 1);
  const int height = std::max(3, static_cast<int>(std::floor(kSeenWidth * sleeve.diameter * scale)) | 1);
  cv::Mat picture(height, width, CV_8U);
  for (int x = 0; x < width; ++x) {
    double sum = 0;
    for (int i = 0; i < kSamples; ++i)
      sum += meanReflectance(sleeve, (x - width / 2 + (i + 0.5) / kSamples - 0.5) / scale);
    picture.col(x).setTo(255 * sum / kSamples);
  }
  return picture;
}

/// Offset of the top of a parabola through three values from the middle one.
double parabolaTop(double left, double middle, double right) {
  const double curvature = left - 2 * middle + right;
  return curvature < 0 ? std::clamp(0.5 * (left - right) / curvature, -0.5, 0.5) : 0;
}

/// Bars look the same wherever they are cut: across a sleeve the correlation has a plateau, and its middle is that of
/// the rod.
double plateauMiddle(const cv::Mat& map, const cv::Point& top, double score) {
  constexpr double kEdge = 0.93;
  int first = top.y, last = top.y;
  while (first > 0 && map.at<float>(first - 1, top.x) > kEdge * score) --first;
  while (last < map.rows - 1 && map.at<float>(last + 1, top.x) > kEdge * score) ++last;
  return 0.5 * (first + last);
}

}  // namespace

struct MarkerFinder::Impl {
  using Confirm = MarkerFinder::Confirm;
  MarkerDesign design;
  MarkerSearch range;
  std::optional<double> last_scale, last_angle;

  bool turns() const { return std::holds_alternative<SleeveDesign>(design); }

  cv::Mat picture(double scale) const {
    return std::visit([scale](const auto& marker) { return pictureOf(marker, scale); }, design);
  }

  std::vector<double> scales() const {
    if (last_scale) return {*last_scale / 1.03, *last_scale, *last_scale * 1.03};
    std::vector<double> scales;
    for (double scale = range.lowest_scale; scale < range.highest_scale * kScaleStep; scale *= kScaleStep)
      scales.push_back(scale);
    return scales;
  }

  std::vector<double> angles() const {
    if (!turns()) return {0};
    constexpr double kNear = 3 * M_PI / 180;
    if (last_angle) return {*last_angle - kNear, *last_angle, *last_angle + kNear};
    std::vector<double> angles;
    for (double angle = 0; angle < 2 * M_PI - 1e-6; angle += kAngleStep) angles.push_back(angle);
    return angles;
  }

  /// The best place for each angle and scale, the best of all first.
  std::vector<MarkerSighting> searchAt(const cv::Mat& image, const std::vector<double>& some_angles,
                                       const std::vector<double>& some_scales) const {
    std::vector<cv::Mat> pictures;
    for (const double scale : some_scales) pictures.push_back(picture(scale));
    std::vector<MarkerSighting> places;
    for (const double angle : some_angles) {
      cv::Matx23d to_turned;
      const cv::Mat turned = turn(image, angle, to_turned);
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        if (pictures[i].cols > turned.cols || pictures[i].rows > turned.rows) continue;
        places.push_back(correlate(turned, pictures[i], to_turned, angle, some_scales[i], turns()));
      }
    }
    std::sort(places.begin(), places.end(),
              [](const MarkerSighting& a, const MarkerSighting& b) { return a.score > b.score; });
    return places;
  }

  /// The image turned about its centre by -angle, so that u lies to the right.
  static cv::Mat turn(const cv::Mat& image, double angle, cv::Matx23d& to_turned) {
    to_turned = cv::Matx23d(1, 0, 0, 0, 1, 0);
    if (angle == 0) return image;
    const double c = std::cos(angle), s = std::sin(angle);
    const double width = std::abs(c) * image.cols + std::abs(s) * image.rows;
    const double height = std::abs(s) * image.cols + std::abs(c) * image.rows;
    const double x = 0.5 * (image.cols - 1), y = 0.5 * (image.rows - 1);
    to_turned = cv::Matx23d(c, s, 0.5 * (width - 1) - c * x - s * y, -s, c, 0.5 * (height - 1) + s * x - c * y);
    cv::Mat turned;
    cv::warpAffine(image, turned, to_turned, cv::Size(static_cast<int>(width), static_cast<int>(height)),
                   cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
    return turned;
  }

  static MarkerSighting correlate(const cv::Mat& turned, const cv::Mat& picture, const cv::Matx23d& to_turned,
                                  double angle, double scale, bool plateau) {
    cv::Mat map;
    cv::matchTemplate(turned, picture, map, cv::TM_CCOEFF_NORMED);
    cv::Point at;
    double score = 0;
    cv::minMaxLoc(map, nullptr, &score, nullptr, &at);
    MarkerSighting best;
    if (!(score > 0) || score > 1.001) return best;
    double x = at.x, y = at.y;
    if (at.x > 0 && at.x < map.cols - 1)
      x += parabolaTop(map.at<float>(at.y, at.x - 1), score, map.at<float>(at.y, at.x + 1));
    if (at.y > 0 && at.y < map.rows - 1)
      y += parabolaTop(map.at<float>(at.y - 1, at.x), score, map.at<float>(at.y + 1, at.x));
    if (plateau) y = plateauMiddle(map, at, score);
    x += picture.cols / 2 - to_turned(0, 2);
    y += picture.rows / 2 - to_turned(1, 2);
    best.score = score;
    best.pixel = {to_turned(0, 0) * x + to_turned(1, 0) * y, to_turned(0, 1) * x + to_turned(1, 1) * y};
    best.direction = {std::cos(angle), std::sin(angle)};
    best.pixels_per_metre = scale;
    return best;
  }

  /// The whole image at half the resolution: places that may be the marker, some of every size, the best first.
  std::vector<MarkerSighting> searchRoughly(const cv::Mat& image) const {
    cv::Mat half;
    cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
    std::vector<double> half_scales = scales();
    for (double& scale : half_scales) scale /= 2;
    std::vector<MarkerSighting> distinct;
    for (MarkerSighting& place : searchAt(half, angles(), half_scales)) {
      place.pixel = 2 * place.pixel + Eigen::Vector2d::Constant(0.5);  // of pixel centres
      place.pixels_per_metre *= 2;
      const auto same_size = [&place](const MarkerSighting& other) {
        return other.pixels_per_metre == place.pixels_per_metre;
      };
      const auto same = [&](const MarkerSighting& other) {
        return same_size(other) && (other.pixel - place.pixel).norm() < kSamePlace &&
               other.direction.dot(place.direction) > 0;
      };
      if (std::count_if(distinct.begin(), distinct.end(), same_size) < kPerScale &&
          std::none_of(distinct.begin(), distinct.end(), same))
        distinct.push_back(place);
    }
    return distinct;
  }

  /// @param confirmed  whether the result is
  std::optional<MarkerSighting> search(const cv::Mat& image, const Confirm& confirm, bool& confirmed) const {
    MarkerSighting best;
    confirmed = false;
    for (const MarkerSighting& place : searchRoughly(image)) {
      const MarkerSighting refined = refine(image, place);
      if (refined.score < kMinScore) continue;
      if (confirm(refined)) {
        confirmed = true;
        return refined;
      }
      if (refined.score > best.score) best = refined;
    }
    if (best.score < kMinScore) return std::nullopt;
    return best;
  }

  cv::Rect neighbourhood(const MarkerSighting& sighting, const cv::Mat& image) const {
    const cv::Mat shape = picture(sighting.pixels_per_metre);
    const int reach = static_cast<int>(0.55 * std::hypot(shape.cols, shape.rows)) + 8;
    const int x = static_cast<int>(std::lround(sighting.pixel.x())),
              y = static_cast<int>(std::lround(sighting.pixel.y()));
    return cv::Rect(x - reach, y - reach, 2 * reach + 1, 2 * reach + 1) & cv::Rect(0, 0, image.cols, image.rows);
  }

  MarkerSighting refine(const cv::Mat& whole, const MarkerSighting& rough) const {
    const cv::Rect region = neighbourhood(rough, whole);
    MarkerSighting best = rough;
    best.score = 0;
    if (region.empty()) return best;
    const cv::Mat image = whole(region);
    for (double step = 1; step > 0.2; step /= 2) {
      const double angle = std::atan2(best.direction.y(), best.direction.x());
      const double scale = best.pixels_per_metre, by = 1 + 0.03 * step, turn_by = 0.07 * step;
      std::vector<double> near{angle};
      if (turns()) near = {angle - turn_by, angle, angle + turn_by};
      const std::vector<MarkerSighting> places = searchAt(image, near, {scale / by, scale, scale * by});
      if (!places.empty() && places.front().score > best.score) best = places.front();
    }
    best.pixel += Eigen::Vector2d(region.x, region.y);
    return best;
  }
};

MarkerFinder::MarkerFinder(const MarkerDesign& design, const MarkerSearch& search)
    : impl_(std::make_unique<Impl>(Impl{design, search, {}, {}})) {
  if (!(search.lowest_scale > 0) || !(search.highest_scale >= search.lowest_scale)) {
    throw Error("a marker cannot be searched between these scales; give the lower one first, both above 0");
  }
}

MarkerFinder::~MarkerFinder() = default;

std::optional<MarkerSighting> MarkerFinder::find(const ImageView& image, const Confirm& confirm) {
  const cv::Mat grey = image.mat();
  bool confirmed = false;
  std::optional<MarkerSighting> best = impl_->search(grey, confirm, confirmed);
  if (!best && impl_->last_scale) {  // perhaps it turned or came nearer
    impl_->last_scale.reset();
    impl_->last_angle.reset();
    best = impl_->search(grey, confirm, confirmed);
  }
  if (!confirmed) return best;
  impl_->last_scale = best->pixels_per_metre;
  impl_->last_angle = std::atan2(best->direction.y(), best->direction.x());
  return best;
}

}  // namespace vibe::vision
