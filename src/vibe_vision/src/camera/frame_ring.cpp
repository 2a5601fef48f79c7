#include "vibe_vision/camera/frame_ring.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vibe_core/common/error.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision {
namespace {

constexpr int kMaxFrames = 5000;
constexpr int kSearched = 3000;  // frames from the beginning of the scene, of which one is the first
constexpr double kSpeedScale = 0.5, kAngularScale = 30;  // of the standard scene [m/s], [rad/s]

/// How fast anything moves at a frame, relative to the speeds of the standard scene.
double restlessness(const SyntheticScene& scene, int frame) {
  const double h = 1e-4, t = frame / scene.rate;
  double most = 0;
  for (const SyntheticInstrument& instrument : scene.instruments) {
    const SyntheticMotion& motion = instrument.motion;
    most = std::max(most, std::abs(motion.slide(t + h) - motion.slide(t - h)) / (2 * h * kSpeedScale));
    most = std::max(most, std::abs(motion.rotation(t + h) - motion.rotation(t - h)) / (2 * h * kAngularScale));
  }
  return most;
}

/// First and last frame, at least half as many as are allowed.
std::pair<int, int> calmEnds(const SyntheticScene& scene, int frames) {
  std::vector<double> cost;
  for (int k = 0; k < kSearched + frames; ++k) cost.push_back(restlessness(scene, k));
  std::pair<int, int> best{0, frames - 1};
  double least = 1e9;
  for (int a = 0; a < kSearched; ++a) {
    if (cost[static_cast<std::size_t>(a)] >= least) continue;
    for (int b = a + frames / 2; b < a + frames; ++b) {
      const double worst = std::max(cost[static_cast<std::size_t>(a)], cost[static_cast<std::size_t>(b)]);
      if (worst >= least) continue;
      least = worst;
      best = {a, b};
    }
  }
  return best;
}

}  // namespace

FrameRing::Turn FrameRing::turnOf(std::uint64_t k) const {
  const std::size_t count = frames.size();
  if (count < 2) return {};
  const std::size_t i = k % (2 * count - 2);
  return i < count ? Turn{i, false} : Turn{2 * count - 2 - i, true};
}

std::shared_ptr<const FrameRing> renderRing(const SyntheticScene& scene, int frames) {
  if (frames < 1 || frames > kMaxFrames) {
    throw Error("fake camera: " + std::to_string(frames) + " frames; draw 1 to " + std::to_string(kMaxFrames) + ".");
  }
  auto ring = std::make_shared<FrameRing>();
  ring->width = scene.camera.width;
  ring->height = scene.camera.height;
  ring->rate = scene.rate;
  ring->exposure = scene.degradation.exposure;
  for (const SyntheticInstrument& instrument : scene.instruments) ring->instruments.push_back(instrument.nominal.name);
  const Renderer renderer(scene);
  const auto [first, last] = calmEnds(scene, frames);
  for (int k = first; k <= last; ++k) {
    const RenderedFrame drawn = renderer.render(static_cast<std::uint64_t>(k));
    const ImageView& view = drawn.frame.image;
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < view.height; ++y) pixels.insert(pixels.end(), view.row(y), view.row(y) + view.width);
    ring->frames.push_back(std::move(pixels));
    ring->truth.push_back(drawn.truth);
  }
  return ring;
}

}  // namespace vibe::vision
