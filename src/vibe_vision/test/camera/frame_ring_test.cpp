#include "vibe_vision/camera/fake_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision::frame_ring_test {

TEST(FrameRing, GoesForwardAndBackward) {
  FrameRing ring;
  ring.frames.resize(4);
  std::vector<std::size_t> order;
  std::vector<bool> backward;
  for (std::uint64_t k = 0; k < 8; ++k) {
    order.push_back(ring.turnOf(k).index);
    backward.push_back(ring.turnOf(k).is_backward);
  }
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 2, 1, 0, 1}));
  EXPECT_EQ(backward, (std::vector<bool>{false, false, false, false, true, true, false, false}));
}

TEST(FrameRing, ASinglePictureStays) {
  FrameRing ring;
  ring.frames.resize(1);
  EXPECT_EQ(ring.turnOf(5).index, 0U);
}

TEST(FrameRing, RenderedPicturesAreThoseOfTheSceneAndTurnWhereItIsCalm) {
  SyntheticScene scene = namedScene("moving");
  const auto ring = renderRing(scene, 60);
  ASSERT_GE(ring->frames.size(), 30U);
  ASSERT_LE(ring->frames.size(), 60U);
  ASSERT_EQ(ring->truth.size(), ring->frames.size());
  EXPECT_EQ(ring->instruments, (std::vector<std::string>{"helix", "needle_driver"}));
  for (std::size_t i = 0; i < 2; ++i) {
    double peak = 0;
    for (const auto& truth : ring->truth) peak = std::max(peak, std::abs(truth[i].velocity));
    EXPECT_GT(peak, 4000);  // 0.4 m/s: the ring is not calm as a whole
    EXPECT_LT(std::abs(ring->truth.front()[i].velocity), 0.25 * peak);
    EXPECT_LT(std::abs(ring->truth.back()[i].velocity), 0.25 * peak);
  }
  const Renderer renderer(scene);
  bool is_found = false;  // the pixels of one frame of the scene, and its truth
  for (std::uint64_t k = 0; k < 3100 && !is_found; ++k) {
    if (truthAt(scene, 0, static_cast<double>(k) / scene.rate).slide != ring->truth[7][0].slide) continue;
    const RenderedFrame drawn = renderer.render(k);
    is_found = std::equal(drawn.frame.image.row(100), drawn.frame.image.row(100) + 728, &ring->frames[7][100 * 728]);
  }
  EXPECT_TRUE(is_found);
}

TEST(FrameRing, AnAbsurdNumberOfFramesIsRefused) {
  EXPECT_THROW(renderRing(standardScene(), 0), Error);
  EXPECT_THROW(renderRing(standardScene(), 1 << 30), Error);
}

}  // namespace vibe::vision::frame_ring_test
