#include "synthetic/plane_surface.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::vision {
PlaneMap::PlaneMap(const CameraModel& camera, const MarkerFrame& frame, const Eigen::Vector2d& reference,
                   double aperture) {
  const ViewRay ray(camera, reference);
  const double depth = frame.away.dot(frame.centre) / frame.scale;
  along_ = ray.part(frame.along * depth - frame.away * (frame.along.dot(frame.centre) / frame.scale));
  across_ = ray.part(frame.across * depth - frame.away * (frame.across.dot(frame.centre) / frame.scale));
  depth_ = ray.part(frame.away);
  const float half = static_cast<float>(aperture) / 2;
  step_x_[0] = along(half, 0) - along(-half, 0);
  step_x_[1] = across(half, 0) - across(-half, 0);
  step_y_[0] = along(0, half) - along(0, -half);
  step_y_[1] = across(0, half) - across(0, -half);
  aperture_ = std::sqrt(std::abs(step_x_[0] * step_y_[1] - step_x_[1] * step_y_[0]));
}

void RingSurface::row(const float* x, const float* y, int count, float* coverage, float* white) const {
  const auto outer = static_cast<float>(design_.outer_diameter / 2);
  const auto inner = static_cast<float>(design_.inner_diameter / 2);
  const auto half = static_cast<float>(design_.side / 2);
  const float inverse = 1 / map_.aperture();
  for (int i = 0; i < count; ++i) {
    const float u = map_.along(x[i], y[i]), v = map_.across(x[i], y[i]);
    coverage[i] = edgeShare(half - std::abs(u), inverse) * edgeShare(half - std::abs(v), inverse);
    const float radius = std::sqrt(u * u + v * v), outward = 1 / (radius + 1e-9F);
    const ApertureSpread spread = map_.spread(u * outward, v * outward);
    white[i] = 1 - positiveShare(outer - radius, spread) + positiveShare(inner - radius, spread);
  }
}

TagSurface::TagSurface(const SyntheticTag& tag, const PlaneMap& map)
    : tag_(tag), map_(map), cell_(static_cast<float>(tag.side / tag.cells)) {}

float TagSurface::cellWhite(int column, int row) const {
  if (column < 0 || row < 0 || column >= tag_.cells || row >= tag_.cells) return 1;
  return tag_.white[static_cast<std::size_t>(row * tag_.cells + column)] ? 1.0F : 0.0F;
}

void TagSurface::row(const float* x, const float* y, int count, float* coverage, float* white) const {
  const float width = map_.aperture() / cell_, inverse = cell_ / map_.aperture();
  const float middle = static_cast<float>(tag_.cells) / 2, half = middle + 1;
  for (int i = 0; i < count; ++i) {
    const float u = map_.along(x[i], y[i]) / cell_, v = map_.across(x[i], y[i]) / cell_;
    coverage[i] = edgeShare((half - std::abs(u)) * inverse, 1) * edgeShare((half - std::abs(v)) * inverse, 1);
    white[i] = 1;
    if (coverage[i] <= 0) continue;
    // The aperture overlaps at most 2 x 2 cells; shares of the right and the lower ones.
    const float left = u + middle - width / 2, top = v + middle - width / 2;
    const int column = static_cast<int>(std::floor(left)), row = static_cast<int>(std::floor(top));
    const float right = std::max(0.0F, left + width - static_cast<float>(column + 1)) * inverse;
    const float lower = std::max(0.0F, top + width - static_cast<float>(row + 1)) * inverse;
    const float upper_white = (1 - right) * cellWhite(column, row) + right * cellWhite(column + 1, row);
    const float lower_white = (1 - right) * cellWhite(column, row + 1) + right * cellWhite(column + 1, row + 1);
    white[i] = (1 - lower) * upper_white + lower * lower_white;
  }
}

}  // namespace vibe::vision
