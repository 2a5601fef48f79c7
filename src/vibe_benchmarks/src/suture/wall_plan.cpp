#include "suture/wall_plan.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

namespace {

constexpr int kCurveSamples = 200;

std::vector<Eigen::Vector3d> verticesOf(const SurfaceView& wall) {
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t v = 0; v < wall.x.size(); ++v) vertices.push_back(wall.position(static_cast<int>(v)));
  return vertices;
}

}  // namespace

Eigen::Vector3d placeOf(const WallPoint& point, const SurfaceView& wall) {
  const auto& corners = wall.triangles[static_cast<std::size_t>(point.triangle)];
  return point.weight[0] * wall.position(corners[0]) + point.weight[1] * wall.position(corners[1]) +
         point.weight[2] * wall.position(corners[2]);
}

WallPlan::WallPlan(const Organ& organ, const SurfaceView& wall) : map_(organ, verticesOf(wall)) {
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int k = 0; k <= kCurveSamples; ++k) {
    curve_axis_.push_back(map_.alongIn(Region::Body, 1 - static_cast<double>(k) / kCurveSamples));
    const Eigen::Vector3d here = map_.position(map_.at(curve_axis_.back(), 0));
    curve_length_.push_back(k == 0 ? 0 : curve_length_.back() + (here - last).norm());
    last = here;
  }
  if (!(length() > 0)) throw Error("The body of the organ has no greater curvature; check its landmarks.");
}

WallPoint WallPlan::at(double along, double across) const {
  const auto next = std::lower_bound(curve_length_.begin() + 1, curve_length_.end() - 1, along);
  const std::size_t k = static_cast<std::size_t>(next - curve_length_.begin());
  const double step = curve_length_[k] - curve_length_[k - 1];
  const double part = step > 0 ? std::clamp((along - curve_length_[k - 1]) / step, 0.0, 1.0) : 0;
  return map_.walk(map_.at((1 - part) * curve_axis_[k - 1] + part * curve_axis_[k], 0), 0, -across);
}

std::vector<Eigen::Vector2d> bitesOfU(int bites) {
  if (bites < 4 || bites % 3 != 1)
    throw Error("A pattern of " + std::to_string(bites) +
                " bites cannot have three equal legs; ask for 4, 7 or 10 bites per set.");
  const int vectors = (bites - 1) / 3;
  const std::array<Eigen::Vector2d, 4> corners{{{-1, 0}, {1, 0}, {1, 1}, {-1, 1}}};
  std::vector<Eigen::Vector2d> places{corners.front()};
  for (std::size_t leg = 1; leg < corners.size(); ++leg)
    for (int k = 1; k <= vectors; ++k)
      places.push_back(corners[leg - 1] + (corners[leg] - corners[leg - 1]) * k / vectors);
  return places;
}

std::vector<std::vector<WallPoint>> planSets(const WallPlan& plan, const SetLayout& layout) {
  const std::vector<Eigen::Vector2d> drawing = bitesOfU(layout.bites);
  const double pitch = plan.length() / layout.sets;
  std::vector<std::vector<WallPoint>> sets;
  for (int k = 0; k < layout.sets; ++k) {
    const double begin = pitch * (k + 0.5 * (1 - layout.share));
    sets.emplace_back();
    for (const Eigen::Vector2d& p : drawing)
      sets.back().push_back(plan.at(begin + layout.share * pitch * p.y(), layout.half_width * p.x()));
  }
  return sets;
}

}  // namespace vibe::benchmarks
