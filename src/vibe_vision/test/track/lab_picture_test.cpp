// Pictures as a laboratory takes them: bold print, noise, dirt, too much light.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "vibe_vision/synthetic/renderer.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::lab_picture_test {
namespace {

constexpr int kPlaces = 3;

struct Lab {
  double ink = 0;        ///< beyond each edge [m]
  double noise = 1;      ///< standard deviation, of what is stated
  double dirt = 0;       ///< share of the area, in spots of 1.5 px radius
  float dirt_value = 0;  ///< [DN]
  double light = 1;
};

/// Both instruments as they truly are; the configuration knows nothing of it.
SyntheticScene sceneOf(const Lab& lab) {
  SyntheticScene scene = namedScene("moving");
  for (SyntheticInstrument& i : scene.instruments) i.nominal.marker = printed(i.nominal.marker, lab.ink);
  scene.degradation.noise.gain *= lab.noise * lab.noise;
  scene.degradation.noise.read *= lab.noise;
  scene.white *= lab.light, scene.black *= lab.light, scene.background *= lab.light;
  return scene;
}

void soil(const Lab& lab, unsigned seed, RenderedFrame& rendered, std::vector<std::uint8_t>& pixels) {
  ImageView& image = rendered.frame.image;
  pixels.assign(image.data, image.data + static_cast<std::ptrdiff_t>(image.stride) * image.height);
  image.data = pixels.data();
  std::mt19937 random(seed);
  const int spots = static_cast<int>(lab.dirt * image.width * image.height / (M_PI * 1.5 * 1.5));
  for (int k = 0; k < spots; ++k) {
    const int x = 2 + static_cast<int>(random() % (image.width - 4)),
              y = 2 + static_cast<int>(random() % (image.height - 4));
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        pixels[static_cast<std::size_t>((y + dy) * image.stride + x + dx)] = static_cast<std::uint8_t>(lab.dirt_value);
  }
}

/// Calls `see` with each frame's measurements. @param apart  frames from one to the next  @param fresh  each is the
/// first that a tracker sees
void look(const Lab& lab, std::uint64_t apart, bool fresh, int frames,
          const std::function<void(const Measurement&, const SyntheticTruth&)>& see) {
  const VisionConfig config = nominalConfig(namedScene("moving"));
  const Renderer renderer(sceneOf(lab));
  Tracker tracker(config);
  for (int k = 0; k < frames; ++k) {
    RenderedFrame rendered = renderer.render(apart * static_cast<std::uint64_t>(k));
    std::vector<std::uint8_t> pixels;
    soil(lab, static_cast<unsigned>(k), rendered, pixels);
    if (fresh && k > 0) tracker = Tracker(config);
    const Measurements& all = tracker.track(rendered.frame);
    for (std::size_t i = 0; i < all.size(); ++i) see(all[i], rendered.truth[i]);
  }
}

/// Both markers in every frame, and no error that was not stated.
void expectFound(const Lab& lab, const std::string& name) {
  int found = 0;
  look(lab, 11, true, kPlaces, [&](const Measurement& m, const SyntheticTruth& truth) {
    found += m.tracked() ? 1 : 0;
    if (!m.tracked()) return;
    EXPECT_LT(std::abs(m.along - truth.along), 5 * std::sqrt(m.along_variance)) << name;
    EXPECT_LT(std::abs(m.along - truth.along), 0.1) << name;
    if (std::isfinite(m.rotation)) {
      EXPECT_LT(std::abs(std::remainder(m.rotation - truth.rotation, 2 * M_PI)), 0.05) << name;
    }
  });
  EXPECT_EQ(found, 2 * kPlaces) << name;
}

TEST(LabPicture, LinesOfAnotherWidthThanDesigned) {
  for (const double ink : {-25e-6, 10e-6, 25e-6}) expectFound({ink}, std::to_string(1e6 * ink) + " um");
}

TEST(LabPicture, TheWidthIsLearnt) {
  for (const double ink : {0.0, 5e-6, 12e-6}) {
    double last = 0;
    look({ink}, 1, false, 10, [&](const Measurement& m, const SyntheticTruth&) {
      if (m.tracked()) last = m.ink;
      EXPECT_NE(m.doubt, Doubt::Bent);
    });
    EXPECT_NEAR(last, ink, 2e-6);
    if (ink == 0) {
      EXPECT_EQ(last, 0);
    }
  }
}

TEST(LabPicture, MoreNoiseThanStated) {
  for (const double noise : {1.5, 2.5}) expectFound({0, noise}, std::to_string(noise) + " times the noise");
}

TEST(LabPicture, NoiseThatIsNotTheStatedOneIsNamed) {
  for (const double noise : {1.0, 2.0}) {
    int named = 0;
    look({0, noise}, 1, false, 8,
         [&](const Measurement& m, const SyntheticTruth&) { named += m.doubt == Doubt::Noise ? 1 : 0; });
    EXPECT_EQ(named > 8, noise > 1.2) << noise;
  }
}

TEST(LabPicture, Dirt) {
  for (const float value : {20.F, 220.F}) expectFound({0, 1, 0.04, value}, "dirt of " + std::to_string(value));
}

TEST(LabPicture, TooMuchLightIsNamed) {
  look({0, 1, 0, 0, 1.7}, 11, true, kPlaces,
       [](const Measurement& m, const SyntheticTruth&) { EXPECT_EQ(m.reason, LostReason::Saturated); });
}

TEST(LabPicture, ARepeatedFrameIsNotTrackedAgain) {
  const SyntheticScene scene = namedScene("moving");
  const Renderer renderer(scene);
  Tracker once(nominalConfig(scene)), twice(nominalConfig(scene));
  for (std::uint64_t k = 0; k < 6; ++k) {
    const RenderedFrame rendered = renderer.render(k);
    twice.track(rendered.frame);
    const Measurements &a = once.track(rendered.frame), &b = twice.track(rendered.frame);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].along, b[i].along);
      EXPECT_EQ(a[i].along_variance, b[i].along_variance);
      EXPECT_EQ(a[i].reacquired, b[i].reacquired);
    }
  }
}

}  // namespace
}  // namespace vibe::vision::lab_picture_test
