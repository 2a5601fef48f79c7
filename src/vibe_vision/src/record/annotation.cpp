#include "vibe_vision/record/annotation.hpp"

#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace vibe {
namespace {

const cv::Scalar kAxisColour(200, 160, 60), kTrackedColour(60, 220, 60), kLostColour(60, 60, 230);  // BGR
constexpr int kSubpixelBits = 4;
constexpr int kAxisPoints = 32;
constexpr double kCross = 12;  // [px]

cv::Point fixedPoint(const Eigen::Vector2d& pixel, const Frame& frame) {
  const double scale = 1 << kSubpixelBits;
  return {static_cast<int>(std::lround((pixel.x() - frame.offset_x) * scale)),
          static_cast<int>(std::lround((pixel.y() - frame.offset_y) * scale))};
}

void drawLine(cv::Mat& picture, const Frame& frame, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
              const cv::Scalar& colour) {
  if (!a.allFinite() || !b.allFinite()) return;
  cv::line(picture, fixedPoint(a, frame), fixedPoint(b, frame), colour, 1, cv::LINE_AA, kSubpixelBits);
}

void drawAxis(cv::Mat& picture, const VisionConfig& config, const InstrumentConfig& instrument, const Frame& frame) {
  const auto at = [&](int i) {
    const double slide = instrument.lower + (instrument.upper - instrument.lower) * i / kAxisPoints;
    return distort(config.camera, instrument.axis.origin + alongOf(instrument.axis, slide) * instrument.axis.direction);
  };
  for (int i = 0; i < kAxisPoints; ++i) drawLine(picture, frame, at(i), at(i + 1), kAxisColour);
}

std::string describe(const std::string& name, const Measurement& m) {
  if (!m.tracked()) return name + ": lost, " + toText(m.reason);
  char text[120];
  std::snprintf(text, sizeof text, ": %.3f mm", 1e3 * m.slide);
  std::string line = name + text;
  if (!std::isfinite(m.rotation)) return line;
  std::snprintf(text, sizeof text, ", %.1f deg", m.rotation * 180 / M_PI);
  return line + text;
}

}  // namespace

cv::Mat annotate(const VisionConfig& config, const Frame& frame, const Measurements& measurements) {
  const ImageView& view = frame.image;
  // OpenCV does not write to it
  const cv::Mat grey(view.height, view.width, CV_8U, const_cast<std::uint8_t*>(view.data),
                     static_cast<std::size_t>(view.stride));
  cv::Mat picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Measurement& m = measurements[i];
    const cv::Scalar colour = m.tracked() ? kTrackedColour : kLostColour;
    drawAxis(picture, config, config.instruments[i], frame);
    const cv::Point place(8, view.height - 10 - 20 * static_cast<int>(measurements.size() - 1 - i));
    cv::putText(picture, describe(config.instruments[i].name, m), place, cv::FONT_HERSHEY_SIMPLEX, 0.5, colour, 1,
                cv::LINE_AA);
    if (!m.tracked()) continue;
    const Eigen::Vector2d d = kCross * config.instruments[i].axis.direction, n(-d.y(), d.x());
    drawLine(picture, frame, m.pixel - d, m.pixel + d, colour);
    drawLine(picture, frame, m.pixel - n, m.pixel + n, colour);
  }
  return picture;
}

}  // namespace vibe
