#include "vibe_vision/synthetic/renderer.hpp"

#include <algorithm>
#include <cmath>

#include "synthetic/random_field.hpp"
#include "synthetic/tile_renderer.hpp"

namespace vibe::vision {
namespace {

constexpr int kStripHeight = 32;  // of the pieces that an occluder is drawn in [px]

/// The background through the optics.
std::vector<float> blurBackground(const Background& background, const PixelKernel& kernel) {
  const std::vector<float>& weights = kernel.latticeWeights();
  const int reach = static_cast<int>(weights.size()) / 2;
  const auto width = static_cast<std::size_t>(background.width());
  std::vector<float> rows(width * static_cast<std::size_t>(background.height() + 2 * reach), 0.0F);
  for (int y = -reach; y < background.height() + reach; ++y) {
    const int limit = Background::kPadding - 1;
    const float* from = background.row(std::clamp(y, -limit, background.height() + limit)) + Background::kPadding;
    float* to = rows.data() + static_cast<std::size_t>(y + reach) * width;
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (std::size_t x = 0; x < width; ++x) {
        const int column = static_cast<int>(x) + static_cast<int>(k) - reach;
        to[x] += weights[k] * from[std::clamp(column, -limit, background.width() + limit)];
      }
  }
  std::vector<float> image(width * static_cast<std::size_t>(background.height()), 0.0F);
  for (int y = 0; y < background.height(); ++y)
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const float* from = rows.data() + (static_cast<std::size_t>(y) + k) * width;
      float* to = image.data() + static_cast<std::size_t>(y) * width;
      for (std::size_t x = 0; x < width; ++x) to[x] += weights[k] * from[x];
    }
  return image;
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const SyntheticScene& scene_in)
      : scene(scene_in), tiles(scene_in), background(blurBackground(tiles.background(), tiles.kernel())) {
    for (int y = 0; scene.degradation.vignetting != 0 && y < scene.camera.height; ++y)
      for (int x = 0; x < scene.camera.width; ++x) light.push_back(static_cast<float>(vignetteAt(scene, x, y)));
  }

  std::vector<cv::Rect> piecesOf(const Exposure& exposure) const;
  std::vector<float> expected(std::uint64_t index) const;
  void vignette(std::vector<float>& image) const;

  SyntheticScene scene;
  TileRenderer tiles;
  std::vector<float> background;  // blurred, at full light
  std::vector<float> light;       // share that the lens lets through; empty: all
};

/// Where the image is not just background.
std::vector<cv::Rect> Renderer::Impl::piecesOf(const Exposure& exposure) const {
  const cv::Rect image(0, 0, scene.camera.width, scene.camera.height);
  const int reach = tiles.kernel().margin() + 1;
  std::vector<cv::Rect> pieces;
  for (std::size_t i = 0; i < tiles.objectCount(); ++i)
    pieces.push_back(image & grown(tiles.boundsOf(i, exposure), reach));
  const Occluder& bar = tiles.occluder();
  for (int y = 0; bar.present && y < image.height; y += kStripHeight) {
    const double middle = bar.middle(exposure.middle(), y + kStripHeight / 2.0);
    const double half = bar.half_width + bar.speed * (exposure.end - exposure.begin) +
                        std::abs(bar.slope) * kStripHeight / 2 + reach + 1;
    const int left = static_cast<int>(middle - half), right = static_cast<int>(middle + half) + 1;
    pieces.push_back(image & cv::Rect(left, y, right - left, kStripHeight));
  }
  return pieces;
}

void Renderer::Impl::vignette(std::vector<float>& image) const {
  if (scene.degradation.vignetting == 0) return;
  for (std::size_t i = 0; i < image.size(); ++i) image[i] *= light[i];
}

std::vector<float> Renderer::Impl::expected(std::uint64_t index) const {
  const double middle = static_cast<double>(index) / scene.rate, half = scene.degradation.exposure / 2;
  const Exposure exposure{middle - half, middle + half};
  const auto mean = static_cast<float>(meanLight(scene.degradation, exposure.begin, exposure.end));
  std::vector<float> image(background.size());
  std::transform(background.begin(), background.end(), image.begin(), [&](float v) { return v * mean; });
  for (const cv::Rect& piece : piecesOf(exposure)) tiles.render(piece, exposure, image.data());
  vignette(image);
  return image;
}

Renderer::Renderer(const SyntheticScene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::vector<float> Renderer::renderExpected(std::uint64_t index) const {
  return impl_->expected(index);
}

RenderedFrame Renderer::render(std::uint64_t index, double start) const {
  const SyntheticScene& scene = impl_->scene;
  const std::vector<float> expected = impl_->expected(index);
  auto pixels = std::make_shared<std::vector<std::uint8_t>>(expected.size());
  const PixelNoise& noise = scene.degradation.noise;
  // Rounding adds a variance of 1 / 12, which PixelNoise::read contains.
  const auto variance = static_cast<float>(noise.read * noise.read - 1.0 / 12);
  addNoise(RandomStream(scene.seed, index), 0, expected.data(), static_cast<int>(expected.size()),
           static_cast<float>(noise.gain), variance, pixels->data());

  RenderedFrame rendered;
  Frame& frame = rendered.frame;
  frame.image = {pixels->data(), scene.camera.width, scene.camera.height, scene.camera.width};
  frame.owner = pixels;
  frame.sensor_width = scene.camera.width;
  frame.sensor_height = scene.camera.height;
  frame.sequence = index;
  frame.stamp = start + static_cast<double>(index) / scene.rate;
  frame.exposure = scene.degradation.exposure;
  frame.arrival = frame.stamp + frame.exposure / 2;
  for (std::size_t i = 0; i < scene.instruments.size(); ++i)
    rendered.truth.push_back(truthAt(scene, i, static_cast<double>(index) / scene.rate));
  return rendered;
}

}  // namespace vibe::vision
