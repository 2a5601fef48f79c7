// Errors of the ring against truth; limits per scene, and against the Cramer-Rao bound, are in vibe_vision_evidence.
#include <gtest/gtest.h>

#include "track/ring_scene.hpp"

namespace vibe::vision::ring_accuracy_test {
namespace {

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
