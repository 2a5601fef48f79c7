#include "geometry/basins.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>
#include <unordered_set>

#include "geometry/descent.hpp"

namespace vibe {
namespace {

constexpr double kSameHeight = 1e-7, kSameLevel = 1e-6;  // [m]
constexpr double kDeepest = 0.3;                         // [m]
constexpr int kOverflows = 40;                           // of one pour; what is left then stays in the last hollow
constexpr double kGrowth = 1.2;                          // of a flood between two looks at its volume

}  // namespace

/// Vertices in the order in which a rising level reaches them from the bottom.
struct Basins::Flood {
  using Entry = std::pair<double, std::uint32_t>;  // height, vertex
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> shore;
  std::unordered_set<std::uint32_t> reached, wet;  // vertices, triangles
  double level;

  Flood(std::uint32_t bottom, double height) : reached{bottom}, level(height) { shore.emplace(height, bottom); }
};

double volumeOnTriangle(double projected, Eigen::Vector3d depth) {
  std::sort(depth.data(), depth.data() + 3, std::greater<>());
  const double a = depth[0], b = depth[1], c = depth[2];
  if (a <= 0) return 0;
  if (c >= 0) return projected * (a + b + c) / 3;
  // the mean depth over the part below the level times its share of the area
  if (b <= 0) return projected * a * a * a / (3 * (a - b) * (a - c));
  return projected * ((a + b + c) / 3 - c * c * c / (3 * (a - c) * (b - c)));
}

Basins::Basins(const WallSurface& wall, const Eigen::Vector3d& down) : wall_(wall), down_(down) {}

double Basins::volumeBelow(double level, const std::vector<std::uint32_t>& triangles) const {
  double sum = 0;
  for (const std::uint32_t t : triangles) {
    const std::uint32_t* corner = wall_.corners(t);
    const Eigen::Vector3d &a = wall_.places()[corner[0]], &b = wall_.places()[corner[1]],
                          &c = wall_.places()[corner[2]];
    const double projected = 0.5 * (b - a).cross(c - a).dot(down_);  // outward is down on a floor
    sum +=
        volumeOnTriangle(projected, {level - height(corner[0]), level - height(corner[1]), level - height(corner[2])});
  }
  return sum;
}

/// The level at which the volume is reached, above `low`; `low` where it never is, because the wall faces down.
double Basins::levelOf(const Pool& pool, double low) const {
  double step = 1e-4, high = low, floor = low;
  for (; step < kDeepest && volumeBelow(high, pool.triangles) < pool.volume; step *= 2) floor = high, high += step;
  if (!(step < kDeepest)) return low;
  while (high - floor > kSameLevel) {
    const double middle = 0.5 * (floor + high);
    (volumeBelow(middle, pool.triangles) < pool.volume ? floor : high) = middle;
  }
  return high;
}

std::optional<std::size_t> Basins::poolAt(std::uint32_t bottom) const {
  for (std::size_t k = 0; k < pools_.size(); ++k)
    for (const std::uint32_t own : pools_[k].bottoms)
      if (own == bottom) return k;
  return std::nullopt;
}

void Basins::absorb(std::size_t pool, Pool& into) {
  const Pool& other = pools_[pool];
  const double volume = into.volume + other.volume;
  if (volume > 0) into.brown = (into.brown * into.volume + other.brown * other.volume) / volume;
  into.volume = volume;
  into.bottoms.insert(into.bottoms.end(), other.bottoms.begin(), other.bottoms.end());
  pools_.erase(pools_.begin() + static_cast<std::ptrdiff_t>(pool));
}

/// Takes in the hollow behind a brim if it is full to the same brim.
bool Basins::joins(std::uint32_t bottom, double level, Pool& pool) {
  const std::optional<std::size_t> other = poolAt(bottom);
  if (!other || pools_[*other].level < level - 10 * kSameHeight) return false;
  absorb(*other, pool);
  return true;
}

void Basins::wet(std::uint32_t vertex, Flood& flood, Pool& pool) const {
  for (const std::uint32_t* t = wall_.around().begin(vertex); t != wall_.around().end(vertex); ++t) {
    if (flood.wet.insert(*t).second) pool.triangles.push_back(*t);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = wall_.corners(*t)[k];
      if (flood.reached.insert(next).second) flood.shore.emplace(height(next), next);
    }
  }
}

/// Raises the level until the pool has its volume. @return false: it has run over at `brim`, and `rest` is too much
bool Basins::fill(Pool& pool, std::uint32_t& brim, double& rest) {
  Flood flood(pool.bottoms.front(), height(pool.bottoms.front()));
  double low = flood.level;
  std::size_t looked = 8;
  while (!flood.shore.empty()) {
    const auto [h, vertex] = flood.shore.top();
    // down again: into another hollow, or one that the pool has taken in already
    const std::uint32_t bottom =
        h < flood.level - kSameHeight ? bottomBelow(wall_, vertex, down_) : pool.bottoms.front();
    const bool over = std::find(pool.bottoms.begin(), pool.bottoms.end(), bottom) == pool.bottoms.end();
    if (over || flood.reached.size() > looked) {
      const double held = volumeBelow(flood.level, pool.triangles);
      if (held >= pool.volume) break;
      low = flood.level;
      looked = static_cast<std::size_t>(kGrowth * static_cast<double>(flood.reached.size()));
      if (over && !joins(bottom, flood.level, pool)) {
        rest = pool.volume - std::max(0.0, held);
        pool.volume -= rest, pool.level = flood.level;
        brim = vertex;
        return false;
      }
    }
    flood.shore.pop();
    flood.level = std::max(flood.level, h);
    wet(vertex, flood, pool);
  }
  pool.level = levelOf(pool, low);
  return true;
}

void Basins::pour(std::uint32_t vertex, double volume, double brown) {
  for (int k = 0; k <= kOverflows && volume > 0; ++k) {
    Pool pool;
    pool.bottoms = {bottomBelow(wall_, vertex, down_)};
    pool.volume = volume, pool.brown = brown;
    if (const std::optional<std::size_t> here = poolAt(pool.bottoms.front())) {
      pool.bottoms.clear();
      absorb(*here, pool);
    }
    volume = 0;
    if (!fill(pool, vertex, volume)) brims_.push_back(vertex);
    if (k == kOverflows) pool.volume += volume;
    pools_.push_back(std::move(pool));
  }
}

}  // namespace vibe
