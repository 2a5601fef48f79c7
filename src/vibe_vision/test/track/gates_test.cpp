// Every gate: a picture that passes and one that does not.
#include "track/gates.hpp"

#include <gtest/gtest.h>

#include "track/outcome.hpp"
#include "track/ring_scene.hpp"

namespace vibe::vision::gates_test {
namespace {

using test::rest;
using test::ringScene;

/// What the tracker says about the first frame of a scene, under its nominal configuration unless changed.
template <class Change>
Measurement first(const SyntheticScene& scene, const Change& change) {
  VisionConfig config = nominalConfig(scene);
  change(config);
  Tracker tracker(config);
  return tracker.track(Renderer(scene).render(0).frame)[0];
}

Measurement first(const SyntheticScene& scene) {
  return first(scene, [](VisionConfig&) {});
}

TEST(Gates, Contrast) {
  SyntheticScene scene = ringScene("static");
  scene.white = 120, scene.black = 80;
  EXPECT_TRUE(first(scene).tracked());
  EXPECT_FALSE(first(scene, [](VisionConfig& config) { config.gates.min_contrast = 50; }).tracked());
}

TEST(Gates, ContrastOfTheWrongSign) {
  SyntheticScene scene = ringScene("static");
  EXPECT_TRUE(first(scene).tracked());
  std::swap(scene.white, scene.black);
  EXPECT_FALSE(first(scene).tracked());
}

TEST(Gates, Size) {
  SyntheticScene scene = ringScene("static");
  scene.instruments[0].scale = 1.1;
  EXPECT_TRUE(first(scene).tracked());
  EXPECT_NEAR(first(scene).scale, 1.1, 0.005);
  EXPECT_EQ(first(scene, [](VisionConfig& config) { config.gates.max_scale_error = 0.05; }).reason,
            LostReason::Mismatch);
  scene.instruments[0].scale = 0.75;  // a look-alike in the marker's place
  EXPECT_FALSE(first(scene).tracked());
}

TEST(Gates, Tilt) {
  SyntheticScene scene = ringScene("tilt");
  EXPECT_TRUE(first(scene).tracked());
  EXPECT_EQ(first(scene, [](VisionConfig& config) { config.gates.max_tilt = 0.1; }).reason, LostReason::Mismatch);
}

TEST(Gates, PlaceBesideTheAxis) {
  SyntheticScene scene = ringScene("static");
  scene.instruments[0].lateral = 4e-4;
  EXPECT_TRUE(first(scene).tracked());
  EXPECT_FALSE(first(scene, [](VisionConfig& config) { config.instruments[0].lateral_tolerance = 1e-4; }).tracked());
}

TEST(Gates, Range) {
  SyntheticScene scene = ringScene("static");
  rest(scene, 0.01);
  EXPECT_TRUE(first(scene).tracked());
  EXPECT_FALSE(first(scene, [](VisionConfig& config) { config.instruments[0].upper = 0.009; }).tracked());
}

TEST(Gates, AnotherRing) {
  SyntheticScene scene = ringScene("static");
  VisionConfig config = nominalConfig(scene);
  Tracker same(config);
  EXPECT_TRUE(same.track(Renderer(scene).render(0).frame)[0].tracked());
  std::get<RingDesign>(scene.instruments[0].nominal.marker).inner_diameter = 3.2e-3;  // instead of 2 mm
  const Renderer renderer(scene);
  Tracker other(config);
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Measurement& m = other.track(renderer.render(i).frame)[0];
    EXPECT_FALSE(m.tracked()) << "frame " << i;
  }
}

TEST(Gates, ShareThatIsSeen) {
  SyntheticScene scene = ringScene("static");
  const Renderer renderer(scene);
  RenderedFrame rendered = renderer.render(10);
  const Eigen::Vector2d centre = rendered.truth[0].pixel;
  std::vector<std::uint8_t> pixels(
      rendered.frame.image.data, rendered.frame.image.data + rendered.frame.image.width * rendered.frame.image.height);
  const auto cover = [&](double from) {  // everything right of the centre + from
    for (int y = 0; y < rendered.frame.image.height; ++y)
      for (int x = static_cast<int>(centre.x() + from); x < static_cast<int>(centre.x()) + 60; ++x)
        pixels[static_cast<std::size_t>(y * rendered.frame.image.width + x)] = 60;
    Frame frame = rendered.frame;
    frame.image.data = pixels.data();
    Tracker tracker(nominalConfig(scene));
    for (std::uint64_t i = 0; i < 10; ++i) tracker.track(renderer.render(i).frame);
    return tracker.track(frame)[0];
  };
  const Measurement most = cover(13);
  ASSERT_TRUE(most.tracked()) << toText(most.reason);
  EXPECT_LT(most.visible, 0.95);
  EXPECT_LT(std::abs(most.along - rendered.truth[0].along), 5 * std::sqrt(most.along_variance) + 0.02);
  EXPECT_FALSE(cover(-12).tracked());
  EXPECT_FALSE(cover(-25).tracked());
}

TEST(Reach, OfAnInstrument) {
  const Reach reach(0.8, {});
  MotionFilter::State state;
  state.covariance.diagonal().setConstant(1e-12);
  EXPECT_TRUE(reach.contains(0.8 * 0.0068, state, 0, 0.0068));
  EXPECT_FALSE(reach.contains(0.8 * 0.0068 + 2e-4, state, 0, 0.0068));
}

TEST(Reach, IsGivenUpWhereThreeFramesAgree) {
  Reach reach(0.8, {});
  MotionFilter::State state;
  state.covariance.diagonal().setConstant(1e-12);
  EXPECT_FALSE(reach.believes(0.02, 0.007, state, 0, 0.007));
  EXPECT_FALSE(reach.believes(0.01, 0.014, state, 0, 0.007));  // elsewhere: counted anew
  EXPECT_FALSE(reach.believes(0.01, 0.021, state, 0, 0.007));
  EXPECT_TRUE(reach.believes(0.01, 0.028, state, 0, 0.007));
}

TEST(Gates, ALookAlikeBesideTheMarkerIsNeverReported) {
  SyntheticScene scene = ringScene("look_alike");
  const test::RingErrors errors = test::runRing(scene, 100);
  EXPECT_EQ(errors.tracked, 100);
  EXPECT_EQ(errors.wrong, 0);
}

}  // namespace
}  // namespace vibe::vision::gates_test
