// Pictures of a renderer that is not ours, Blender's Cycles, drawn from the printed sheet with light, paper and lens of
// its own (docs/vision.md, "Another renderer"). Three frames each of five situations, cut around the markers, and of
// a sixth with the sleeve alone: shade, gloss, gamma and a lens out of focus at once.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include <fstream>
#include <map>
#include <sstream>

#include "vibe_core/files/files.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::evidence::second_renderer_test {
namespace {

const std::string kFolder = "package://vibe_vision_evidence/test/pictures/blender/";

struct Sample {
  std::string image, instrument;
  double sequence = 0, stamp = 0, exposure = 0, offset_x = 0, offset_y = 0, slide = 0, rotation = 0;
};

std::vector<Sample> loadSamples() {
  std::ifstream file(resolveAddress(kFolder + "labels.csv"));
  std::vector<Sample> samples;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream words(line);
    Sample s;
    std::getline(words, s.image, ',');
    std::getline(words, s.instrument, ',');
    for (double* value : {&s.sequence, &s.stamp, &s.exposure, &s.offset_x, &s.offset_y, &s.slide, &s.rotation}) {
      std::string word;
      std::getline(words, word, ',');
      *value = std::stod(word);
    }
    samples.push_back(s);
  }
  return samples;
}

/// A configuration with this instrument alone.
VisionConfig configOf(const std::string& instrument) {
  VisionConfig config = VisionConfig::load(kFolder + "config.yaml");
  config.instruments = {config.instruments[config.indexOf(instrument)]};
  return config;
}

Measurement trackSample(Tracker& tracker, const Sample& sample) {
  const cv::Mat pixels = cv::imread(resolveAddress(kFolder + sample.image), cv::IMREAD_GRAYSCALE);
  Frame frame;
  frame.image = {pixels.data, pixels.cols, pixels.rows, static_cast<int>(pixels.step)};
  frame.sensor_width = tracker.config().camera.width, frame.sensor_height = tracker.config().camera.height;
  frame.offset_x = static_cast<int>(sample.offset_x), frame.offset_y = static_cast<int>(sample.offset_y);
  frame.sequence = static_cast<std::uint64_t>(sample.sequence);
  frame.stamp = sample.stamp, frame.exposure = sample.exposure;
  return tracker.track(frame).front();
}

/// Shading, defocus and a response that the renderer of this package cannot draw, too.
TEST(SecondRenderer, MarkersAreFoundWhereTheyAre) {
  std::map<std::string, Tracker> trackers;
  int count = 0, lost = 0;
  for (const Sample& sample : loadSamples()) {
    const std::string sequence = sample.image.substr(0, sample.image.rfind('_'));
    Tracker& tracker = trackers.try_emplace(sequence, configOf(sample.instrument)).first->second;
    const Measurement m = trackSample(tracker, sample);
    ++count;
    if (!m.tracked()) {
      ++lost;
      continue;
    }
    EXPECT_NEAR(m.slide, sample.slide, 1e-5) << sample.image;  // a tenth of a pixel
    if (sample.instrument != "helix") continue;
    EXPECT_LT(std::abs(std::remainder(m.rotation - sample.rotation, 2 * M_PI)), 0.05) << sample.image;
  }
  EXPECT_EQ(count, 33);
  EXPECT_LE(lost, 1);  // known: the second frame of the sleeve under a response that nobody gave
}

/// A response that nobody gave is told where it was found, and no other.
TEST(SecondRenderer, TheResponseIsTold) {
  std::map<std::string, Tracker> trackers;
  std::map<std::string, Doubt> last;
  for (const Sample& sample : loadSamples()) {
    if (sample.instrument == "helix") continue;
    const std::string sequence = sample.image.substr(0, sample.image.rfind("_needle"));
    Tracker& tracker = trackers.try_emplace(sequence, configOf(sample.instrument)).first->second;
    last[sequence] = trackSample(tracker, sample).doubt;
  }
  for (const auto& [sequence, doubt] : last)
    EXPECT_EQ(doubt, sequence == "gamma22" ? Doubt::Response : Doubt::None) << sequence;
}

/// Out of focus, a wrong motion during the exposure explains a blurred ring nearly as well as the right one.
TEST(SecondRenderer, ADefocusedRingIsFoundInEveryFrame) {
  for (const bool given : {true, false}) {
    VisionConfig config = configOf("needle_driver");
    if (given) config.gamma = 1;
    int found = 0;
    for (const Sample& sample : loadSamples()) {
      if (sample.image.rfind("defocus2_needle", 0) != 0) continue;
      Tracker tracker(config);  // none knows anything
      const Measurement m = trackSample(tracker, sample);
      found += m.tracked() && std::abs(m.slide - sample.slide) < 5e-6 ? 1 : 0;
    }
    EXPECT_EQ(found, 3) << (given ? "gamma given" : "gamma unknown");
  }
}

/// A wrong response is not tracked silently at a wrong place: it is lost, or right.
TEST(SecondRenderer, AGivenResponseIsTaken) {
  for (const double gamma : {1.0, 2.2}) {
    VisionConfig config = configOf("needle_driver");
    config.gamma = gamma;
    Tracker tracker(config);
    for (const Sample& sample : loadSamples()) {
      if (sample.image != "gamma22_needle_driver_0.png") continue;
      EXPECT_EQ(trackSample(tracker, sample).tracked(), gamma > 1) << gamma;
    }
  }
}

}  // namespace
}  // namespace vibe::vision::evidence::second_renderer_test
