#include "synthetic/tile_renderer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "synthetic/surface.hpp"

namespace vibe::vision {
namespace {

constexpr int kFewSamples = 2;   // per pixel and direction, where motion smooths the picture
constexpr int kManySamples = 4;  // elsewhere
constexpr double kWideBlur = 1;  // standard deviation that does, too [px]
constexpr double kSmooth = 1;    // motion that does [px]
constexpr double kStep = 0.5;    // between two moments, largest [px]
constexpr double kStill = 0.02;  // motion that needs no second moment [px]
constexpr int kMaxMoments = 256;

/// Middle of a sample. [px]
double sampleCentre(int first_pixel, int sample, float side) {
  return first_pixel - 0.5 + (sample + 0.5) * side;
}

}  // namespace

cv::Rect grown(const cv::Rect& rect, int by) {
  return {rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by};
}

struct TileRenderer::Layer {
  std::unique_ptr<Surface> surface;
  cv::Rect bounds;
  const Highlights* highlights = nullptr;
};

struct TileRenderer::Moment {
  double time = 0;
  float light = 1;  // times the share of the exposure
  std::vector<Layer> layers;
};

struct TileRenderer::Grid {
  cv::Rect rect;
  int samples = 0;            // per pixel and direction
  float side = 0;             // of a sample [px]
  int columns = 0, rows = 0;  // of samples
  Eigen::Vector2d reference;  // undistorted [px]
  double aperture = 0;        // side of a sample, undistorted [px]
  std::vector<float> x, y;    // undistorted, relative to the reference [px]
};

TileRenderer::TileRenderer(const SyntheticScene& scene)
    : scene_(scene),
      objects_(objectsOf(scene)),
      map_(scene.camera),
      background_(scene.camera.width, scene.camera.height, scene.background, scene.seed),
      kernel_(scene.degradation.blur, kFewSamples),
      fine_kernel_(scene.degradation.blur, kManySamples),
      occluder_(scene) {
  for (std::size_t i = 0; i < scene.instruments.size(); ++i) highlights_.emplace_back(scene, i);
}

TileRenderer::~TileRenderer() = default;

cv::Rect TileRenderer::boundsAt(std::size_t object, double time) const {
  const MarkerFrame frame = markerFrame(scene_.camera, objects_[object], time);
  const Eigen::Vector2d half = halfExtents(objects_[object]);
  Eigen::Vector2d low = project(scene_.camera, frame.centre), high = low;
  for (const double u : {-1.0, 0.0, 1.0})
    for (const double v : {-1.0, 0.0, 1.0})
      for (const double w : {-1.0, 0.0}) {
        const bool round =
            objects_[object].tag.cells == 0 && std::holds_alternative<SleeveDesign>(objects_[object].nominal.marker);
        const Eigen::Vector3d point = frame.centre + u * half.x() * frame.along + v * half.y() * frame.across +
                                      (round ? w * half.y() : 0) * frame.away;
        const Eigen::Vector2d pixel = project(scene_.camera, point);
        low = low.cwiseMin(pixel);
        high = high.cwiseMax(pixel);
      }
  constexpr double kClear = 1;  // the lens bends edges between corners
  const auto bound = [](double v) { return static_cast<int>(std::floor(std::clamp(v, -1e5, 1e5))); };
  return {cv::Point(bound(low.x() - kClear), bound(low.y() - kClear)),
          cv::Point(bound(high.x() + kClear) + 2, bound(high.y() + kClear) + 2)};
}

cv::Rect TileRenderer::boundsOf(std::size_t object, const Exposure& exposure) const {
  const cv::Rect all = boundsAt(object, exposure.middle());
  const double reach = 0.6 * (exposure.end - exposure.begin);  // moments reach a little beyond the exposure
  return all | boundsAt(object, exposure.middle() - reach) | boundsAt(object, exposure.middle() + reach);
}

double TileRenderer::pathLength(std::size_t object, const Exposure& exposure) const {
  const MarkerFrame a = markerFrame(scene_.camera, objects_[object], exposure.begin);
  const MarkerFrame b = markerFrame(scene_.camera, objects_[object], exposure.middle());
  const MarkerFrame c = markerFrame(scene_.camera, objects_[object], exposure.end);
  const auto path = [&](const MarkerFrame& from, const MarkerFrame& to) {
    const double slid = (project(scene_.camera, to.centre) - project(scene_.camera, from.centre)).norm();
    const double turned = std::abs(to.rotation - from.rotation) * halfExtents(objects_[object]).y() *
                          objects_[object].nominal.axis.pixels_per_metre;
    return slid + turned;
  };
  return path(a, b) + path(b, c);
}

std::vector<TileRenderer::Moment> TileRenderer::moments(const cv::Rect& rect, const Exposure& exposure,
                                                        const Grid& grid) const {
  std::vector<std::size_t> seen;
  double longest = occluder_.present ? occluder_.speed * (exposure.end - exposure.begin) : 0;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if ((rect & boundsOf(i, exposure)).empty()) continue;
    seen.push_back(i);
    longest = std::max(longest, pathLength(i, exposure));
  }
  const int count = longest < kStill ? 1 : std::clamp(static_cast<int>(std::ceil(longest / kStep)), 2, kMaxMoments);
  // Evenly spaced moments spread less than the exposure they stand for: by 1 - 1 / count^2 in variance.
  const double widen = count > 1 ? 1 / std::sqrt(1 - 1.0 / (static_cast<double>(count) * count)) : 1;
  const double length = (exposure.end - exposure.begin) / count;
  std::vector<Moment> all(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    Moment& moment = all[static_cast<std::size_t>(k)];
    const double begin = exposure.begin + k * length;
    moment.time = exposure.middle() + widen * (begin + length / 2 - exposure.middle());
    moment.light = static_cast<float>(meanLight(scene_.degradation, begin, begin + length) / count);
    for (const std::size_t i : seen) {
      const MarkerFrame frame = markerFrame(scene_.camera, objects_[i], moment.time);
      const Highlights* highlights = i < highlights_.size() ? &highlights_[i] : nullptr;
      moment.layers.push_back({makeSurface(scene_.camera, objects_[i], frame, grid.reference, grid.aperture),
                               boundsAt(i, moment.time), highlights});
    }
    // Look-alikes are behind the instruments.
    std::reverse(moment.layers.begin(), moment.layers.end());
  }
  return all;
}

TileRenderer::Grid TileRenderer::makeGrid(const cv::Rect& rect, int samples) const {
  Grid grid;
  grid.samples = samples;
  grid.side = 1.0F / static_cast<float>(samples);
  grid.rect = rect;
  grid.columns = rect.width * samples;
  grid.rows = rect.height * samples;
  const SensorMap::Entry middle = map_.at((rect.x + rect.x + rect.width) / 2, (rect.y + rect.y + rect.height) / 2);
  grid.reference = middle.place;
  grid.aperture = grid.side * std::sqrt(std::abs(static_cast<double>(middle.jacobian.determinant())));
  grid.x.resize(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  grid.y.resize(grid.x.size());
  for (int py = rect.y; py < rect.br().y; ++py)
    for (int px = rect.x; px < rect.br().x; ++px) {
      const SensorMap::Entry entry = map_.at(px, py);
      const Eigen::Vector2f place = (entry.place - grid.reference).cast<float>();
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const Eigen::Vector2f within((static_cast<float>(i) + 0.5F) * grid.side - 0.5F,
                                       (static_cast<float>(j) + 0.5F) * grid.side - 0.5F);
          const Eigen::Vector2f point = place + entry.jacobian * within;
          const auto at =
              static_cast<std::size_t>((py - rect.y) * samples + j) * static_cast<std::size_t>(grid.columns) +
              static_cast<std::size_t>((px - rect.x) * samples + i);
          grid.x[at] = point.x();
          grid.y[at] = point.y();
        }
    }
  return grid;
}

void TileRenderer::backgroundRow(const Grid& grid, int sample_row, float* values) const {
  const cv::Rect& rect = grid.rect;
  const int limit = Background::kPadding - 1;
  const double y = std::clamp(sampleCentre(rect.y, sample_row, grid.side), -static_cast<double>(limit),
                              static_cast<double>(background_.height() + limit - 1));
  const int row = static_cast<int>(std::floor(y));
  const auto down = static_cast<float>(y - row);
  const float* upper = background_.row(row) + Background::kPadding;
  const float* lower = background_.row(row + 1) + Background::kPadding;
  const auto at = [&](int x) {
    const int column = std::clamp(x, -limit, background_.width() + limit - 1);
    return upper[column] + down * (lower[column] - upper[column]);
  };
  for (int px = rect.x; px < rect.br().x; ++px) {
    const float left = at(px - 1), middle = at(px), right = at(px + 1);
    for (int s = 0; s < grid.samples; ++s) {
      const float t = (static_cast<float>(s) + 0.5F) * grid.side - 0.5F;
      *values++ = middle + (t < 0 ? t * (middle - left) : t * (right - middle));
    }
  }
}

void TileRenderer::layerRow(const Layer& layer, const Grid& grid, int sample_row, float* values, float* scratch) const {
  const int y = grid.rect.y + sample_row / grid.samples;
  if (y < layer.bounds.y || y >= layer.bounds.br().y) return;
  const int first = std::max(0, layer.bounds.x - grid.rect.x) * grid.samples;
  const int count = std::min(grid.rect.width, layer.bounds.br().x - grid.rect.x) * grid.samples - first;
  if (count <= 0) return;
  const auto from =
      static_cast<std::size_t>(sample_row) * static_cast<std::size_t>(grid.columns) + static_cast<std::size_t>(first);
  float *coverage = scratch, *white = scratch + grid.columns;
  layer.surface->row(grid.x.data() + from, grid.y.data() + from, count, coverage, white);
  const auto black = static_cast<float>(scene_.black), contrast = static_cast<float>(scene_.white - scene_.black);
  float* to = values + first;
  for (int i = 0; i < count; ++i) to[i] += coverage[i] * (black + contrast * white[i] - to[i]);
  if (layer.highlights)
    layer.highlights->addTo(to, coverage, count, static_cast<float>(sampleCentre(grid.rect.x, first, grid.side)),
                            grid.side, static_cast<float>(sampleCentre(grid.rect.y, sample_row, grid.side)));
}

void TileRenderer::occluderRow(double time, const Grid& grid, double y, float* values) const {
  const double middle = occluder_.middle(time, y);
  const auto half = static_cast<float>(occluder_.half_width);
  const auto start = static_cast<float>(sampleCentre(grid.rect.x, 0, grid.side) - middle);
  for (int i = 0; i < grid.columns; ++i) {
    const float share =
        edgeShare(half - std::abs(start + static_cast<float>(i) * grid.side), static_cast<float>(grid.samples));
    values[i] += share * (occluder_.value - values[i]);
  }
}

/// True if few samples do: the optics or the motion of everything in the rectangle blurs what they leave of its edges.
bool TileRenderer::isSmoothed(const cv::Rect& rect, const Exposure& exposure) const {
  if (scene_.degradation.blur >= kWideBlur) return true;
  for (std::size_t i = 0; i < objects_.size(); ++i)
    if (!(rect & boundsOf(i, exposure)).empty() && pathLength(i, exposure) < kSmooth) return false;
  return true;
}

void TileRenderer::render(const cv::Rect& rect, const Exposure& exposure, float* image) const {
  if (rect.empty()) return;
  const cv::Rect wide = grown(rect, kernel_.margin());
  const PixelKernel& kernel = isSmoothed(wide, exposure) ? kernel_ : fine_kernel_;
  const Grid grid = makeGrid(wide, kernel.samples());
  const std::vector<Moment> all = moments(wide, exposure, grid);
  const auto columns = static_cast<std::size_t>(grid.columns), width = static_cast<std::size_t>(rect.width);
  std::vector<float> behind(columns), values(columns), sum(columns), scratch(2 * columns);
  std::vector<float> blurred(width * static_cast<std::size_t>(grid.rows));
  for (int r = 0; r < grid.rows; ++r) {
    backgroundRow(grid, r, behind.data());
    std::fill(sum.begin(), sum.end(), 0.0F);
    for (const Moment& moment : all) {
      values = behind;
      for (const Layer& layer : moment.layers) layerRow(layer, grid, r, values.data(), scratch.data());
      if (occluder_.present) occluderRow(moment.time, grid, sampleCentre(wide.y, r, grid.side), values.data());
      for (std::size_t i = 0; i < columns; ++i) sum[i] += moment.light * values[i];
    }
    kernel.alongRow(sum.data(), rect.width, blurred.data() + static_cast<std::size_t>(r) * width);
  }
  const std::vector<float>& weights = kernel.weights();
  for (int y = 0; y < rect.height; ++y) {
    float* to = image + static_cast<std::size_t>(rect.y + y) * static_cast<std::size_t>(scene_.camera.width) + rect.x;
    std::fill(to, to + width, 0.0F);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const float* from = blurred.data() + (static_cast<std::size_t>(y * grid.samples) + k) * width;
      for (std::size_t i = 0; i < width; ++i) to[i] += weights[k] * from[i];
    }
  }
}

}  // namespace vibe::vision
