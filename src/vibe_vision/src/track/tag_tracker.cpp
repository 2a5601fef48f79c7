#include <algorithm>
#include <cmath>

#include "track/arithmetic.hpp"
#include "track/axis_map.hpp"
#include "track/outcome.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision {
namespace {

constexpr double kPatience = 3;  // deviations of a prediction in which a window looks
// Of a corner in one direction [px], of which the centre has half. The detectors leave up to this in the benchmark
// (docs/vision.md, "Tags of other libraries"): an error of their edges that stays as long as the tag stays, not noise.
constexpr double kCorner = 0.2;
constexpr double kCornerKnown = 2;      // degrees of freedom that this is worth beside the two of one picture
constexpr double kOfMotion = 0.02;      // share of the motion during the exposure that a smeared edge may be aside
constexpr double kSlantedShear = 5e-3;  // that a slanted tag may have
constexpr double kRowsAcross = 0.5;     // of the axis' normal, from which a shear is told from an aspect

double sampled(const Frame& frame, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(std::lround(pixel.x())) - frame.offset_x;
  const int y = static_cast<int>(std::lround(pixel.y())) - frame.offset_y;
  if (x < 0 || y < 0 || x >= frame.image.width || y >= frame.image.height) return NAN;
  return frame.image.row(y)[x];
}

/// Reads the tag in a window around the prediction; if it is not there, in the band around the axis.
class TagTracker : public MarkerTracker {
 public:
  TagTracker(const VisionConfig& config, const InstrumentConfig& instrument, const TrackerPolicy& policy)
      : MarkerTracker(instrument, policy),
        camera_(config.camera),
        limits_(config.gates),
        tag_(std::get<TagDesign>(instrument.marker)),
        reader_(tag_, instrument.axis.pixels_per_metre) {}

  const Measurement& track(const Frame& frame) override;

 private:
  /// A tag against the axis.
  struct Look {
    TagPlace place;
    double along = 0, lateral = 0;  ///< of its centre [px]
    double size = 1, tilt = 0;      ///< against the calibrated ones; the tilt to the nearest quarter turn [rad]
    double shear = 0;               ///< along the axis, per pixel across it
    double contrast = 0;            ///< white - black [DN]
    double corner_variance = 0;     ///< of a corner, in one direction [px^2]
  };
  bool search(const Frame& frame, double from, double to, const MotionFilter::State* prediction);
  cv::Rect band(const Frame& frame, double from, double to) const;
  Look lookAt(const Frame& frame, const TagCorners& corners, const Eigen::Vector2d& shift) const;
  double contrastOf(const Frame& frame, const TagPlace& place) const;
  LostReason judge(const Look& look) const;
  void accept(const Frame& frame, const Look& look, bool reacquired);
  void doubt(const Frame& frame, const Look& look, const MotionFilter::State& state);
  LostReason whyNothing(const Frame& frame) const;

  CameraModel camera_;
  GateConfig limits_;
  TagDesign tag_;
  TagReader reader_;
};

const Measurement& TagTracker::track(const Frame& frame) {
  reason_ = LostReason::NotFound;
  if (slide_.started() && (frame.stamp <= slide_.time() || frame.stamp - slide_.time() > policy_.max_gap))
    slide_.reset();
  if (slide_.started()) {
    const MotionFilter::State prediction = slide_.predict(frame.stamp);
    const double room = kPatience * prediction.deviation(), slide = prediction.mean[0];
    if (search(frame, slide - room, slide + room, &prediction)) return measurement_;
    if (search(frame, config_.lower, config_.upper, &prediction)) return measurement_;
  } else if (search(frame, config_.lower, config_.upper, nullptr)) {
    return measurement_;
  }
  return lose(reason_ == LostReason::NotFound ? whyNothing(frame) : reason_);
}

/// Pixels of the full image around a part of the axis, as far as a tag there reaches and the frame shows them.
cv::Rect TagTracker::band(const Frame& frame, double from, double to) const {
  const double scale = config_.axis.pixels_per_metre;
  const double reach = (0.75 * tag_.side + tagMargin(tag_) + config_.lateral_tolerance) * (1 + limits_.max_scale_error);
  const double begin = alongOf(config_.axis, std::max(from, config_.lower)) - reach * scale;
  const double end = alongOf(config_.axis, std::min(to, config_.upper)) + reach * scale;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e6), high = -low;
  constexpr int kPieces = 8;  // the lens bends the band
  for (int i = 0; i <= kPieces; ++i)
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d p =
          distort(camera_, pixelAt(config_.axis, begin + (end - begin) * i / kPieces, side * reach * scale));
      if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
  const auto whole = [](double v, int size) { return static_cast<int>(std::clamp(std::floor(v), 0.0, double(size))); };
  const int x0 = whole(low.x(), camera_.width), x1 = whole(high.x() + 1, camera_.width);
  const int y0 = whole(low.y(), camera_.height), y1 = whole(high.y() + 1, camera_.height);
  return cv::Rect(x0, y0, x1 - x0, y1 - y0) &
         cv::Rect(frame.offset_x, frame.offset_y, frame.image.width, frame.image.height);
}

bool TagTracker::search(const Frame& frame, double from, double to, const MotionFilter::State* prediction) {
  const cv::Rect window = band(frame, from, to);
  if (window.empty()) return false;
  const ImageView view = {frame.image.row(window.y - frame.offset_y) + (window.x - frame.offset_x), window.width,
                          window.height, frame.image.stride};
  const Look* best = nullptr;
  std::vector<Look> looks;
  for (const TagCorners& corners : reader_.find(view)) looks.push_back(lookAt(frame, corners, {window.x, window.y}));
  for (const Look& look : looks) {
    const LostReason reason = judge(look);
    if (reason != LostReason::None && reason_ == LostReason::NotFound) reason_ = reason;
    if (reason == LostReason::None && (best == nullptr || std::abs(look.lateral) < std::abs(best->lateral)))
      best = &look;
  }
  if (best == nullptr) return false;
  if (prediction != nullptr && !reach_.believes(slideOf(config_.axis, best->along), frame.stamp, *prediction,
                                                last_slide_, frame.stamp - slide_.time())) {
    reason_ = LostReason::Jump;
    return false;
  }
  if (reach_.jumped()) slide_.reset();
  measurement_ = {};
  measurement_.roi_x = window.x, measurement_.roi_y = window.y;
  measurement_.roi_width = window.width, measurement_.roi_height = window.height;
  const bool wide = from <= config_.lower && to >= config_.upper;
  accept(frame, *best, wide);
  return true;
}

TagTracker::Look TagTracker::lookAt(const Frame& frame, const TagCorners& corners, const Eigen::Vector2d& shift) const {
  Look look;
  look.place = TagPlace::of(camera_, corners, shift, tag_.side);
  const Eigen::Vector2d direction = config_.axis.direction, across = acrossOf(config_.axis);
  const Eigen::Vector2d offset = look.place.centre - config_.axis.origin;
  look.along = offset.dot(direction), look.lateral = offset.dot(across);
  const double expected = pixelsPerMetre(config_.axis, slideOf(config_.axis, look.along));
  look.size = look.place.pixels_per_metre / expected;
  Eigen::Matrix2d picture;  // along and across, of unit size
  picture << direction.transpose() * look.place.picture, across.transpose() * look.place.picture;
  picture /= look.place.pixels_per_metre;
  const double turned = std::atan2(picture(1, 0) - picture(0, 1), picture(0, 0) + picture(1, 1));
  const double quarter = M_PI / 2 * std::round(turned / (M_PI / 2));
  look.tilt = turned - quarter;
  Eigen::Matrix2d back;
  back << std::cos(turned), std::sin(turned), -std::sin(turned), std::cos(turned);
  const Eigen::Matrix2d rest = picture * back;  // without its turn: symmetric
  look.shear = rest(0, 1) + rest(1, 0);
  look.contrast = contrastOf(frame, look.place);
  const double residual = 4 * square(look.place.misfit);  // of four corners, two degrees of freedom
  look.corner_variance = std::max(square(kCorner), (kCornerKnown * square(kCorner) + residual) / (kCornerKnown + 2));
  return look;
}

/// White margin less black border, half a cell beside the edges.
double TagTracker::contrastOf(const Frame& frame, const TagPlace& place) const {
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  const double half = tag_.side / 2, aside = tagMargin(tag_) / 2;
  for (const double t : {-0.3, 0.0, 0.3})
    for (int side = 0; side < 4; ++side)
      for (int white = 0; white < 2; ++white) {
        const double out = (side % 2 == 0 ? 1 : -1) * (half + (white == 1 ? aside : -aside));
        const Eigen::Vector2d on = side < 2 ? Eigen::Vector2d(out, t * tag_.side) : Eigen::Vector2d(t * tag_.side, out);
        const double value = sampled(frame, distort(camera_, place.centre + place.picture * on));
        if (std::isfinite(value)) sum[white] += value, ++count[white];
      }
  return count[0] > 0 && count[1] > 0 ? sum[1] / count[1] - sum[0] / count[0] : 0;
}

LostReason TagTracker::judge(const Look& look) const {
  const double scale = config_.axis.pixels_per_metre;
  if (look.contrast < limits_.min_contrast) return LostReason::NotFound;
  if (std::abs(look.lateral) > config_.lateral_tolerance * scale + 1) return LostReason::NotFound;
  if (look.along < alongOf(config_.axis, config_.lower) - 1 || look.along > alongOf(config_.axis, config_.upper) + 1)
    return LostReason::NotFound;
  if (std::abs(look.size - 1) > limits_.max_scale_error) return LostReason::Mismatch;
  return std::abs(look.tilt) > limits_.max_tilt ? LostReason::Mismatch : LostReason::None;
}

void TagTracker::accept(const Frame& frame, const Look& look, bool reacquired) {
  const double slide = slideOf(config_.axis, look.along), scale = pixelsPerMetre(config_.axis, slide);
  const double variance = look.corner_variance / 4;
  if (slide_.started())
    slide_.update(frame.stamp, slide, variance / square(scale) + square(policy_.filter_floor));
  else
    slide_.start(frame.stamp, slide, variance / square(scale) + square(policy_.filter_floor));
  last_slide_ = slide;
  reach_.settle();
  const MotionFilter::State state = slide_.predict(frame.stamp);
  const double middle = exposureShift(frame.exposure);
  const double motion = (std::abs(state.mean[1]) + std::sqrt(state.covariance(1, 1))) * frame.exposure * scale;
  measurement_.reason = LostReason::None;
  measurement_.reacquired = reacquired;
  measurement_.along = look.along - scale * state.mean[2] * middle;
  measurement_.along_variance = variance + square(kOfMotion * motion) + square(scale * middle) * state.covariance(2, 2);
  measurement_.slide = slideOf(config_.axis, measurement_.along);
  measurement_.rotation = NAN;
  measurement_.lateral = look.lateral;
  measurement_.pixel = distort(camera_, pixelAt(config_.axis, measurement_.along, look.lateral));
  measurement_.visible = 1;  // what is covered in part is not read
  measurement_.score = 1 / (1 + square(look.place.misfit));
  measurement_.scale = look.size;
  measurement_.tilt = look.tilt;
  measurement_.contrast = look.contrast;
  doubt(frame, look, state);
}

void TagTracker::doubt(const Frame& frame, const Look& look, const MotionFilter::State& state) {
  const double scale = pixelsPerMetre(config_.axis, measurement_.slide), rows = config_.axis.direction.x();
  doubts_.addFit(std::log(look.size), 0);
  if (std::abs(state.mean[1]) > policy_.telling_speed && std::abs(rows) > kRowsAcross) {
    const double variance = 2 * look.corner_variance / square(tag_.side * scale) + square(kSlantedShear);
    doubts_.addShear({look.shear / rows, variance / square(rows)}, state.mean[1] * scale);
  }
  stateDoubts(state, scale, frame.sensor_height);
}

LostReason TagTracker::whyNothing(const Frame& frame) const {
  const cv::Rect window = band(frame, config_.lower, config_.upper);
  const int seen = window.area();
  int saturated = 0, brightest = 0;
  for (int y = window.y; y < window.br().y; ++y)
    for (int x = window.x; x < window.br().x; ++x) {
      const int value = frame.image.row(y - frame.offset_y)[x - frame.offset_x];
      saturated += value >= 253 ? 1 : 0, brightest = std::max(brightest, value);
    }
  const double share = static_cast<double>(saturated) / std::max(seen, 1);
  return vision::whyNothing({seen > 0, share, static_cast<double>(brightest)}, limits_.min_contrast, policy_);
}

}  // namespace

std::unique_ptr<MarkerTracker> makeTagTracker(const VisionConfig& config, const InstrumentConfig& instrument,
                                              const TrackerPolicy& policy) {
  return std::make_unique<TagTracker>(config, instrument, policy);
}

}  // namespace vibe::vision
