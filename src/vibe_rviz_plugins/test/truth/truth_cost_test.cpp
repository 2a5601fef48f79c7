// CPU time of all truth of one image of 640 x 480, for an organ with as many triangles as the default stomach is drawn
// with, in the thread that computes it.

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "truth_worlds.hpp"

namespace vibe {
namespace {

double threadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST(TruthCost, OfAnImageIsBelowTheBudget) {
  constexpr double kBudget = 0.150;   // [s]
  test::FoldedWorld world(120, 120);  // 28,800 triangles
  const TruthCamera camera(test::smallCamera(LensKind::Equidistant, 640, 480), test::kNear, test::kFar);
  TruthView view;
  world.show(0);
  camera.look(world.scene, test::eye(), view);
  std::vector<double> whole, parts[5];
  for (int k = 1; k <= 7; ++k) {
    const double times[] = {threadTime(),
                            (world.show(0.02 * k), threadTime()),
                            (camera.flow(view, world.scene, test::eye(0.02 * k)), threadTime()),
                            (camera.look(world.scene, test::eye(0.02 * k), view), threadTime()),
                            (camera.depth(world.scene, view), camera.normals(world.scene, view), threadTime()),
                            (camera.labels(world.scene, view), threadTime())};
    whole.push_back(times[5] - times[0]);
    for (std::size_t p = 0; p < 5; ++p) parts[p].push_back(times[p + 1] - times[p]);
  }
  const auto median = [](std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + 3, values.end());
    return values[3];
  };
  std::printf("%.1f ms: motion and rebuild %.1f, flow %.1f, rays %.1f, depth and normals %.1f, labels %.1f\n",
              1e3 * median(whole), 1e3 * median(parts[0]), 1e3 * median(parts[1]), 1e3 * median(parts[2]),
              1e3 * median(parts[3]), 1e3 * median(parts[4]));
  EXPECT_LT(median(whole), kBudget);
}

}  // namespace
}  // namespace vibe
