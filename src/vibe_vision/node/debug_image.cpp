#include "debug_image.hpp"

#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace vibe {
namespace {

const cv::Scalar kTracked(80, 220, 80), kLost(60, 60, 255), kAxis(255, 200, 80);  // blue, green, red
constexpr int kFraction = 4;                                                      // bits of drawing below a pixel
constexpr int kAxisPieces = 32;
constexpr int kCross = 12;     // half size [px]
constexpr int kLineStep = 20;  // of the text [px]

/// Draws in coordinates of the full sensor.
class Canvas {
 public:
  explicit Canvas(const Frame& frame) : offset_(frame.offset_x, frame.offset_y) {
    const ImageView& view = frame.image;
    // OpenCV only reads it
    const cv::Mat grey(view.height, view.width, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                       static_cast<std::size_t>(view.stride));
    cv::cvtColor(grey, picture_, cv::COLOR_GRAY2BGR);
  }
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour) {
    if (a.allFinite() && b.allFinite()) cv::line(picture_, at(a), at(b), colour, 1, cv::LINE_AA, kFraction);
  }
  void box(const cv::Rect& box, const cv::Scalar& colour) {
    const cv::Point corner = -cv::Point(static_cast<int>(offset_.x()), static_cast<int>(offset_.y()));
    if (box.area() > 0) cv::rectangle(picture_, box + corner, colour);
  }
  void text(const std::string& text, int line, const cv::Scalar& colour) {
    const cv::Point at(8, kLineStep * (line + 1));
    cv::putText(picture_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, cv::Scalar(0, 0, 0), 3, cv::LINE_AA);
    cv::putText(picture_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, colour, 1, cv::LINE_AA);
  }
  const cv::Mat& picture() const { return picture_; }

 private:
  Eigen::Vector2d offset_;
  cv::Mat picture_;

  cv::Point at(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d p = (pixel - offset_) * (1 << kFraction);
    return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
  }
};

Eigen::Vector2d pixelOf(const VisionConfig& config, const InstrumentConfig& instrument, double slide) {
  return distort(config.camera, instrument.axis.origin + instrument.axis.direction * alongOf(instrument.axis, slide));
}

void drawAxis(const VisionConfig& config, const InstrumentConfig& instrument, Canvas& canvas) {
  const auto at = [&](int i) {
    return pixelOf(config, instrument, instrument.lower + (instrument.upper - instrument.lower) * i / kAxisPieces);
  };
  for (int i = 0; i < kAxisPieces; ++i) canvas.line(at(i), at(i + 1), kAxis);
}

std::string describe(const InstrumentConfig& instrument, const Measurement& measurement, const JointSample& sample) {
  if (!sample.tracked()) return instrument.name + ": lost, " + toText(sample.reason);
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.3f mm +- %.1f um", instrument.name.c_str(), 1e3 * sample.slide,
                1e6 * std::sqrt(sample.variance[0]));
  std::string line = text;
  if (sample.has_rotation) {
    std::snprintf(text, sizeof text, ", %.1f deg +- %.2f", sample.rotation * 180 / M_PI,
                  std::sqrt(sample.variance[1]) * 180 / M_PI);
    line += text;
  }
  std::snprintf(text, sizeof text, ", score %.2f", measurement.score);
  return line + text;
}

}  // namespace

cv::Mat drawDebugImage(const VisionConfig& config, const Frame& frame, const Measurements& measurements,
                       const std::vector<JointSample>& samples) {
  Canvas canvas(frame);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Measurement& measurement = measurements[i];
    const cv::Scalar colour = samples[i].tracked() ? kTracked : kLost;
    drawAxis(config, config.instruments[i], canvas);
    canvas.box({measurement.roi_x, measurement.roi_y, measurement.roi_width, measurement.roi_height}, colour);
    canvas.text(describe(config.instruments[i], measurement, samples[i]), static_cast<int>(i), colour);
    if (!samples[i].tracked()) continue;
    const Eigen::Vector2d along = kCross * config.instruments[i].axis.direction, across(-along.y(), along.x());
    canvas.line(measurement.pixel - along, measurement.pixel + along, colour);
    canvas.line(measurement.pixel - across, measurement.pixel + across, colour);
  }
  return canvas.picture();
}

}  // namespace vibe
