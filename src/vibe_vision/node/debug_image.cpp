#include "debug_image.hpp"

#include <cmath>
#include <cstdio>

#include "vibe_vision/record/annotation.hpp"

namespace vibe::vision {
namespace {

std::string describe(const InstrumentConfig& instrument, const Measurement& measurement, const JointSample& sample) {
  if (!sample.tracked()) return instrument.name + ": lost, " + toText(sample.reason);
  char text[160];
  std::snprintf(text, sizeof text, ": %.3f mm +- %.1f um", 1e3 * sample.slide, 1e6 * std::sqrt(sample.variance[0]));
  std::string line = instrument.name + text;
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
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < samples.size(); ++i)
    texts.push_back(describe(config.instruments[i], measurements[i], samples[i]));
  return annotate(config, frame, measurements, texts);
}

}  // namespace vibe::vision
