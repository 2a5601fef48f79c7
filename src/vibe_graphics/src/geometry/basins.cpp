#include "vibe_graphics/geometry/basins.hpp"

#include <algorithm>
#include <array>
#include <queue>

#include <Eigen/Geometry>

namespace vibe::graphics {

namespace {

using Eigen::Vector3d;

constexpr double kStep = 1.2e-3, kShortest = 0.1e-3;  // [m]
constexpr int kSteps = 400;
constexpr double kFlat = 1e-3;  // sine of a slope on which nothing runs
constexpr double kGain = 0.02;  // of the expected loss of height, below which a step was not downhill

}  // namespace

std::vector<WallPlace> steepestDescent(const WallSurface& wall, const WallPlace& start, const Vector3d& down) {
  std::vector<WallPlace> line(1, start);
  double step = kStep;
  while (line.size() <= kSteps && step > kShortest) {
    const WallPlace& here = line.back();
    const Vector3d slope = down - down.dot(here.inward) * here.inward;
    if (!(slope.norm() > kFlat)) break;
    const WallPlace next = wall.moved(here, step * slope.normalized());
    const double lost = (next.place - here.place).dot(down);
    if (lost > kGain * step * slope.norm()) {
      line.push_back(next);
      step = std::min(kStep, 2 * step);
    } else {
      step /= 2;  // the bottom, or a ridge between triangles, is nearer
    }
  }
  return line;
}

std::uint32_t bottomBelow(const WallSurface& wall, std::uint32_t vertex, const Vector3d& down) {
  for (;;) {
    std::uint32_t lowest = vertex;
    for (const std::uint32_t* t = wall.around().begin(vertex); t != wall.around().end(vertex); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = wall.corners(*t)[k];
        if (wall.places()[other].dot(down) > wall.places()[lowest].dot(down)) lowest = other;
      }
    if (lowest == vertex) return vertex;
    vertex = lowest;
  }
}

std::uint32_t bottomBelow(const WallSurface& wall, const WallPlace& point, const Vector3d& down) {
  std::uint32_t lowest = wall.corners(point.triangle)[0];
  for (int k = 1; k < 3; ++k) {
    const std::uint32_t other = wall.corners(point.triangle)[k];
    if (wall.places()[other].dot(down) > wall.places()[lowest].dot(down)) lowest = other;
  }
  return bottomBelow(wall, lowest, down);
}

namespace {

constexpr double kSameHeight = 1e-7, kSameLevel = 1e-7;  // [m]
constexpr double kDeepest = 0.3;                         // [m]
constexpr int kOverflows = 40;                           // of one pour; what is left then stays in the last hollow
constexpr double kGrowth = 1.2;                          // of a flood between two looks at its volume

}  // namespace

/// Vertices in the order in which a rising level reaches them from the bottom.
struct Basins::Flood {
  using Entry = std::pair<double, std::uint32_t>;  // height, vertex
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> shore;
  std::vector<bool> reached, wet;  // vertices, triangles
  std::size_t count = 1;           // of reached vertices
  std::vector<Column> columns;     // over the wet triangles
  double level;

  Flood(std::uint32_t bottom, double height, std::size_t vertices, std::size_t triangles)
      : reached(vertices, false), wet(triangles, false), level(height) {
    reached[bottom] = true;
    shore.emplace(height, bottom);
  }

  double volumeBelow(double height) const {
    double sum = 0;
    for (const Column& column : columns)
      if (column.low < height)
        sum += volumeOnTriangle(column.projected, height - column.low, height - column.middle, height - column.high);
    return sum;
  }
};

double volumeOnTriangle(double projected, double a, double b, double c) {
  if (a <= 0) return 0;
  if (c >= 0) return projected * (a + b + c) / 3;
  // the mean depth over the part below the level times its share of the area
  if (b <= 0) return projected * a * a * a / (3 * (a - b) * (a - c));
  return projected * ((a + b + c) / 3 - c * c * c / (3 * (a - c) * (b - c)));
}

Basins::Basins(const WallSurface& wall, const Eigen::Vector3d& down) : wall_(wall), down_(down) {}

Basins::Column Basins::columnOver(std::uint32_t triangle) const {
  const std::uint32_t* corner = wall_.corners(triangle);
  const Eigen::Vector3d &a = wall_.places()[corner[0]], &b = wall_.places()[corner[1]], &c = wall_.places()[corner[2]];
  std::array<double, 3> heights{height(corner[0]), height(corner[1]), height(corner[2])};
  std::sort(heights.begin(), heights.end());
  return {0.5 * (b - a).cross(c - a).dot(down_), heights[0], heights[1], heights[2]};  // outward is down on a floor
}

/// The level at which the volume is reached, above `low`; `low` where it never is, because the wall faces down.
double Basins::levelOf(double volume, const Flood& flood, double low) {
  double step = 1e-4, high = low, floor = low;
  for (; step < kDeepest && flood.volumeBelow(high) < volume; step *= 2) floor = high, high += step;
  if (!(step < kDeepest)) return low;
  while (high - floor > kSameLevel) {
    const double middle = 0.5 * (floor + high);
    (flood.volumeBelow(middle) < volume ? floor : high) = middle;
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
    if (flood.wet[*t]) continue;
    flood.wet[*t] = true;
    pool.triangles.push_back(*t);
    flood.columns.push_back(columnOver(*t));
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = wall_.corners(*t)[k];
      if (flood.reached[next]) continue;
      flood.reached[next] = true;
      ++flood.count;
      flood.shore.emplace(height(next), next);
    }
  }
}

/// Raises the level until the pool has its volume. @return false: it has run over at `brim`, and `rest` is too much
bool Basins::fill(Pool& pool, std::uint32_t& brim, double& rest) {
  Flood flood(pool.bottoms.front(), height(pool.bottoms.front()), wall_.places().size(), wall_.triangleCount());
  double low = flood.level;
  std::size_t looked = 8;
  while (!flood.shore.empty()) {
    const auto [h, vertex] = flood.shore.top();
    // down again: into another hollow, or one that the pool has taken in already
    const std::uint32_t bottom =
        h < flood.level - kSameHeight ? bottomBelow(wall_, vertex, down_) : pool.bottoms.front();
    const bool over = std::find(pool.bottoms.begin(), pool.bottoms.end(), bottom) == pool.bottoms.end();
    if (over || flood.count > looked) {
      const double held = flood.volumeBelow(flood.level);
      if (held >= pool.volume) break;
      low = flood.level;
      looked = static_cast<std::size_t>(kGrowth * static_cast<double>(flood.count));
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
  pool.level = levelOf(pool.volume, flood, low);
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
    if (!fill(pool, vertex, volume)) brims_.push_back({vertex, pool.brown});
    if (k == kOverflows) pool.volume += volume;
    pools_.push_back(std::move(pool));
  }
}

}  // namespace vibe::graphics
