// Errors of the ring against truth and against the Cramer-Rao bound.
#include <gtest/gtest.h>

#include "track/ring_scene.hpp"

namespace vibe::vision::ring_accuracy_test {
namespace {

using test::moveAs;
using test::rest;
using test::RingErrors;
using test::ringScene;
using test::runRing;

TEST(RingAccuracy, NoBiasAtAnyPlaceBetweenPixels) {
  constexpr int kPhases = 8, kFrames = 40;
  double sum = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    SyntheticScene scene = ringScene("static");
    scene.seed = 11 + static_cast<std::uint64_t>(phase);
    rest(scene, -3e-3 + 1e-4 * phase / kPhases);
    const RingErrors errors = runRing(scene, kFrames, 10);
    EXPECT_EQ(errors.tracked, kFrames);
    EXPECT_LT(std::abs(errors.bias()), 0.006) << "phase " << phase;
    sum += errors.bias();
  }
  EXPECT_LT(std::abs(sum / kPhases), 0.0025);
}

TEST(RingAccuracy, AtRestNearTheCramerRaoBound) {
  double squares = 0, bound = 0;
  constexpr int kScenes = 6, kFrames = 60;
  for (int k = 0; k < kScenes; ++k) {
    SyntheticScene scene = ringScene("static");
    scene.seed = 31 + static_cast<std::uint64_t>(k);
    rest(scene, 1e-3 * k + 3e-5 * k);
    const RingErrors errors = runRing(scene, kFrames, 20);
    squares += errors.rms() * errors.rms() / kScenes;
    bound = cramerRaoBound(scene, 0, 0).along;
  }
  EXPECT_LT(std::sqrt(squares), 1.3 * bound);
  EXPECT_GT(std::sqrt(squares), 0.9 * bound);  // nobody is better: else the truth leaked
}

struct Target {
  const char* scene;
  double rms;  // [px]
};

class RingDegraded : public ::testing::TestWithParam<Target> {};

TEST_P(RingDegraded, FewPixelsOfErrorAndAnHonestCovariance) {
  SyntheticScene scene = ringScene(GetParam().scene);
  const RingErrors errors = runRing(scene, 150);
  EXPECT_LE(errors.lost_visible, errors.visible / 100);
  EXPECT_EQ(errors.wrong, 0);
  EXPECT_EQ(errors.phantom, 0);
  EXPECT_LT(errors.rms(), GetParam().rms);
  EXPECT_GT(errors.nees(), 0.5);
  EXPECT_LT(errors.nees(), 1.8);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RingDegraded,
                         ::testing::Values(Target{"moving", 0.007}, Target{"long_exposure", 0.03},
                                           Target{"defocus", 0.012}, Target{"light", 0.01}, Target{"highlights", 0.01},
                                           Target{"occluder", 0.008}, Target{"look_alike", 0.007}, Target{"all", 0.04},
                                           Target{"tilt", 0.01}, Target{"scale", 0.01}),
                         [](const auto& instance) { return std::string(instance.param.scene); });

// Flicker of 12 % moves the light's middle of a 1 ms exposure by up to 0.03 px at this speed.
TEST(RingAccuracy, FlickerDoesNotMoveIt) {
  SyntheticScene scene = ringScene("moving");
  scene.degradation.flicker = 0.12;
  EXPECT_LT(runRing(scene, 100, 30).rms(), 0.009);
}

TEST(RingAccuracy, ATooSmallNoiseOfTheCameraIsNoticed) {
  SyntheticScene scene = ringScene("static");
  const Renderer renderer(scene);
  VisionConfig config = nominalConfig(scene);
  config.noise.gain /= 4, config.noise.read /= 4;
  Tracker tracker(config);
  RingErrors errors;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const RenderedFrame rendered = renderer.render(i);
    errors.add(tracker.track(rendered.frame)[0], rendered.truth[0]);
  }
  EXPECT_LT(errors.nees(), 2.5);  // the misfit widens the covariance; without it this is 4
}

}  // namespace
}  // namespace vibe::vision::ring_accuracy_test
