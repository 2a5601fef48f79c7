#include <algorithm>
#include <cmath>

#include "bench/bench_scene.hpp"

namespace vibe::vision::evidence {
namespace {

constexpr double kPixel = 1e-4;  // of the standard scenes [m]

/// A number that looks drawn by lot, 0 to 1, and is the same for the same arguments.
double lot(std::uint64_t seed, std::uint64_t frame, int which) {
  const double x = std::sin(12.9898 * static_cast<double>(frame) + 78.233 * static_cast<double>(seed) + 3.7 * which);
  return 43758.5453 * std::abs(x) - std::floor(43758.5453 * std::abs(x));
}

/// Paints [from, to] along the axis, relative to a marker's middle, as a matt cover would look.
void cover(const SyntheticTruth& truth, double from, double to, double half_height, RenderedFrame& frame) {
  const ImageView& image = frame.frame.image;
  std::uint8_t* pixels = ownPixels(frame.frame);
  const int left = std::max(0, static_cast<int>(std::lround(truth.pixel.x() + from)));
  const int right = std::min(image.width - 1, static_cast<int>(std::lround(truth.pixel.x() + to)));
  const int top = std::max(0, static_cast<int>(truth.pixel.y() - half_height));
  const int bottom = std::min(image.height - 1, static_cast<int>(truth.pixel.y() + half_height));
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const double texture = 12 * std::sin(0.31 * x + 0.17 * y) + 4 * std::sin(1.7 * x - 2.3 * y);
      pixels[y * image.stride + x] = static_cast<std::uint8_t>(105 + texture);
    }
}

/// What tells the rotation of a sleeve is hidden, what tells its place is not: from frame 12 on, or always.
void coverStripe(const SyntheticScene& scene, RenderedFrame& frame) {
  if (scene.seed % 2 == 0 && frame.frame.sequence < 12) return;
  for (std::size_t i = 0; i < frame.truth.size(); ++i)
    if (std::holds_alternative<SleeveDesign>(scene.instruments[i].nominal.marker))
      cover(frame.truth[i], -23, 19, 20, frame);
}

/// A copy of each marker at rest on its axis.
void addCopies(SyntheticScene& scene, std::uint64_t seed) {
  const std::size_t count = scene.instruments.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.instruments[i].tag.cells > 0) continue;
    SyntheticInstrument copy = scene.instruments[i];
    const double place = (seed % 2 == 0 ? 0.012 : -0.009) + 1e-4 * static_cast<double>(seed % 7);
    copy.motion.slide = [place](double) { return place; };
    copy.motion.rotation = [](double) { return 1.3; };
    scene.instruments.push_back(copy);
  }
}

/// The instruments, not their copies, are hidden for half of the time. Every third sequence begins so.
void hideInstruments(const SyntheticScene& scene, RenderedFrame& frame) {
  if ((frame.frame.sequence + (scene.seed % 3 == 0 ? 20 : 0)) % 40 < 20) return;
  for (std::size_t i = 0; i < 2; ++i) {
    cover(frame.truth[i], -58, 58, 36, frame);
    frame.truth[i].visible = 0;
  }
}

/// A band of rows across every marker, in every third frame.
template <class Paint>
void spoilRows(const SyntheticScene& scene, RenderedFrame& frame, const Paint& paint) {
  const std::uint64_t k = frame.frame.sequence;
  if (k % 3 != 2) return;
  ownPixels(frame.frame);
  for (std::size_t i = 0; i < 2; ++i) {
    const double half = std::holds_alternative<SleeveDesign>(scene.instruments[i].nominal.marker) ? 15 : 20;
    const double first = (2 * lot(scene.seed, k, 1) - 1) * half, height = (0.15 + lot(scene.seed, k, 2)) * half;
    const int top = static_cast<int>(frame.truth[i].pixel.y() + first), bottom = static_cast<int>(top + height);
    for (int y = std::max(top, 0); y <= std::min(bottom, frame.frame.image.height - 1); ++y) paint(y);
  }
}

void loseRows(const SyntheticScene& scene, RenderedFrame& frame) {
  spoilRows(scene, frame, [&](int y) {
    auto* row = const_cast<std::uint8_t*>(frame.frame.image.row(y));
    std::fill(row, row + frame.frame.image.width, static_cast<std::uint8_t>(0));
  });
}

/// They show one of the last five frames.
void keepRows(const SyntheticScene& scene, RenderedFrame& frame) {
  const std::uint64_t k = frame.frame.sequence;
  if (k % 3 != 2) return;
  const auto age = std::min<std::uint64_t>(k, 1 + static_cast<std::uint64_t>(5 * lot(scene.seed, k, 3)));
  const RenderedFrame old = Renderer(scene).render(k - age);
  spoilRows(scene, frame, [&](int y) {
    std::copy_n(old.frame.image.row(y), old.frame.image.width, const_cast<std::uint8_t*>(frame.frame.image.row(y)));
  });
}

/// The picture around each axis upside down.
void mirror(const SyntheticScene& scene, RenderedFrame& frame) {
  std::uint8_t* pixels = ownPixels(frame.frame);
  const std::ptrdiff_t stride = frame.frame.image.stride;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto middle = static_cast<int>(std::lround(frame.truth[i].pixel.y()));
    for (int d = 1; d <= 55; ++d)
      std::swap_ranges(pixels + (middle - d) * stride, pixels + (middle - d) * stride + scene.camera.width,
                       pixels + (middle + d) * stride);
  }
}

/// A sleeve that is 3 % wider in one direction, which turns with the rod: its rows are further from the middle or
/// nearer.
void makeOval(const SyntheticScene& scene, RenderedFrame& frame) {
  constexpr double kOval = 0.03;
  std::uint8_t* pixels = ownPixels(frame.frame);
  const ImageView image = frame.frame.image;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto* sleeve = std::get_if<SleeveDesign>(&scene.instruments[i].nominal.marker);
    if (sleeve == nullptr) continue;
    const double radius = sleeve->diameter / 2 / kPixel, cy = frame.truth[i].pixel.y();
    const int top = static_cast<int>(cy - 1.1 * radius), bottom = static_cast<int>(cy + 1.1 * radius) + 1;
    std::vector<std::uint8_t> round(pixels + top * image.stride, pixels + (bottom + 1) * image.stride);
    for (int y = top + 1; y < bottom; ++y) {
      double phi = std::asin(std::clamp((y - cy) / radius, -1.0, 1.0));
      for (int n = 0; n < 3; ++n) {
        const double r = radius * (1 + kOval / 2 * std::cos(2 * (phi - frame.truth[i].rotation)));
        phi = std::asin(std::clamp((y - cy) / r, -1.0, 1.0));
      }
      const double from = std::clamp(cy + radius * std::sin(phi) - top, 0.0, bottom - top - 1.001);
      const auto row = static_cast<std::ptrdiff_t>(from);
      const double share = from - static_cast<double>(row);
      for (int x = 0; x < image.width; ++x)
        pixels[y * image.stride + x] = static_cast<std::uint8_t>(
            std::lround((1 - share) * round[row * image.stride + x] + share * round[(row + 1) * image.stride + x]));
    }
  }
}

}  // namespace

const std::vector<HarderScene>& faultyScenes() {
  using Scene = SyntheticScene;
  using Seed = std::uint64_t;
  const auto nothing = [](Scene&, Seed) {};
  static const std::vector<HarderScene> scenes = {
      {"covered_stripe", "moving", nothing, coverStripe},
      {"covered_stripe_rest", "static", nothing, coverStripe},
      {"copy", "moving", addCopies, hideInstruments},
      {"stale_rows", "moving", nothing, keepRows},
      {"lost_rows", "moving", nothing, loseRows},
      {"lost_rows_rest", "static", nothing, loseRows},
      {"exposure_3ms", "moving", [](Scene& s, Seed) { s.degradation.exposure = 3e-3; },
       [](const Scene&, RenderedFrame& frame) { frame.frame.exposure = 1e-3; }},
      {"flicker_50", "moving", [](Scene& s, Seed) { s.degradation.flicker = 0.5; }, {}},
      {"oval", "moving", nothing, makeOval},
      {"small_print",
       "moving",
       [](Scene& s, Seed) {
         for (SyntheticInstrument& i : s.instruments) i.scale = 0.97;
       },
       {}},
      {"mirrored", "moving", nothing, mirror},
      {"glare", "moving", [](Scene& s, Seed) { s.black = 70, s.white = 330; }, {}},
  };
  return scenes;
}

}  // namespace vibe::vision::evidence
