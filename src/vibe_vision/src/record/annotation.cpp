#include "vibe_vision/record/annotation.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vibe_core/files/number_text.hpp"

namespace vibe::vision {
namespace {

// channels in the order blue, green, red
const cv::Scalar kTrackedColour(80, 220, 80), kLostColour(60, 60, 255), kAxisColour(255, 200, 80);
constexpr int kSubpixelBits = 4;
constexpr int kAxisPieces = 32;
constexpr int kCross = 12;     // half size [px]
constexpr int kLineStep = 20;  // of the text [px]

/// Draws in coordinates of the full sensor.
class Canvas {
 public:
  explicit Canvas(const Frame& frame) : offset_(frame.offset_x, frame.offset_y) {
    cv::cvtColor(frame.image.mat(), picture_, cv::COLOR_GRAY2BGR);
  }
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour) {
    if (a.allFinite() && b.allFinite()) cv::line(picture_, at(a), at(b), colour, 1, cv::LINE_AA, kSubpixelBits);
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
    const Eigen::Vector2d p = (pixel - offset_) * (1 << kSubpixelBits);
    return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
  }
};

void drawAxis(const VisionConfig& config, const InstrumentConfig& instrument, Canvas& canvas) {
  const auto at = [&](int i) {
    const double slide = instrument.lower + (instrument.upper - instrument.lower) * i / kAxisPieces;
    return distort(config.camera, pixelAt(instrument.axis, alongOf(instrument.axis, slide)));
  };
  for (int i = 0; i < kAxisPieces; ++i) canvas.line(at(i), at(i + 1), kAxisColour);
}

void drawCross(const Eigen::Vector2d& pixel, const Eigen::Vector2d& direction, const cv::Scalar& colour,
               Canvas& canvas) {
  const Eigen::Vector2d along = kCross * direction, across(-along.y(), along.x());
  canvas.line(pixel - along, pixel + along, colour);
  canvas.line(pixel - across, pixel + across, colour);
}

std::string describe(const std::string& name, const Measurement& m) {
  if (!m.tracked()) return name + ": lost, " + toText(m.reason);
  std::string line = name + formatted(": %.3f mm", 1e3 * m.slide);
  if (!std::isfinite(m.rotation)) return line;
  return line + formatted(", %.1f deg", m.rotation * 180 / M_PI);
}

}  // namespace

cv::Mat annotate(const VisionConfig& config, const Frame& frame, const Measurements& measurements,
                 const std::vector<std::string>& texts) {
  Canvas canvas(frame);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Measurement& m = measurements[i];
    const cv::Scalar& colour = m.tracked() ? kTrackedColour : kLostColour;
    drawAxis(config, config.instruments[i], canvas);
    canvas.box({m.roi_x, m.roi_y, m.roi_width, m.roi_height}, colour);
    canvas.text(texts[i], static_cast<int>(i), colour);
    if (m.tracked()) drawCross(m.pixel, config.instruments[i].axis.direction, colour, canvas);
  }
  return canvas.picture();
}

cv::Mat annotate(const VisionConfig& config, const Frame& frame, const Measurements& measurements) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < measurements.size(); ++i)
    texts.push_back(describe(config.instruments[i].name, measurements[i]));
  return annotate(config, frame, measurements, texts);
}

}  // namespace vibe::vision
