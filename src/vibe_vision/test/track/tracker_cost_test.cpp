// A tracked frame asks for no memory, and its cost does not depend on the sensor.
#include "vibe_testing/allocation_count.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "track/ring_scene.hpp"
#include "vibe_core/clocks/step_timer.hpp"

namespace vibe::vision::tracker_cost_test {
namespace {

using test::ringScene;

TEST(TrackerCost, NoMemoryPerFrame) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  for (const char* name : {"moving", "all"}) {
    const SyntheticScene scene = ringScene(name);
    const Renderer renderer(scene);
    Tracker tracker(nominalConfig(scene));
    for (std::uint64_t i = 0; i < 60; ++i) {
      const RenderedFrame rendered = renderer.render(i);
      if (i % 20 == 10) tracker.reset();  // the search too
      const long before = vibe::test::allocations;
      tracker.track(rendered.frame);
      if (i > 0) {
        EXPECT_EQ(vibe::test::allocations, before) << name << " frame " << i;
      }
    }
    const long before = vibe::test::allocations;
    const RenderedFrame control = renderer.render(0);
    EXPECT_GT(vibe::test::allocations, before);
  }
}

/// The same scene in the middle of a larger sensor.
SyntheticScene onLargerSensor(SyntheticScene scene, int factor) {
  const Eigen::Vector2d shift((factor - 1) * scene.camera.width / 2, (factor - 1) * scene.camera.height / 2);
  scene.camera.width *= factor, scene.camera.height *= factor;
  scene.camera.cx += shift.x(), scene.camera.cy += shift.y();
  scene.instruments[0].nominal.axis.origin += shift;
  return scene;
}

/// Least thread time of a tracked frame [s].
double cost(const SyntheticScene& scene, bool search) {
  const Renderer renderer(scene);
  std::vector<RenderedFrame> frames;
  for (std::uint64_t i = 0; i < 8; ++i) frames.push_back(renderer.render(i));
  Tracker tracker(nominalConfig(scene));
  double least = 1;
  for (int repeat = 0; repeat < 12; ++repeat) {
    tracker.reset();
    for (const RenderedFrame& rendered : frames) {
      if (search) tracker.reset();
      const double start = threadCpuTime();
      const bool found = tracker.track(rendered.frame)[0].reacquired;
      if (found == search) least = std::min(least, threadCpuTime() - start);
    }
  }
  return least;
}

TEST(TrackerCost, IndependentOfTheSensor) {
  const SyntheticScene small = ringScene("moving"), large = onLargerSensor(small, 3);
  for (bool search : {false, true}) {
    const double a = cost(small, search), b = cost(large, search);
    EXPECT_LT(b, 1.5 * a + 2e-5) << (search ? "search" : "track") << ": " << a << " s and " << b << " s";
  }
}

}  // namespace
}  // namespace vibe::vision::tracker_cost_test
