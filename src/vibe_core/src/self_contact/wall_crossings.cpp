#include "vibe_core/self_contact/wall_crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"

namespace vibe {

namespace {

// Cells of the grid per mean size of a triangle. Design choice: about two triangles of an even mesh per cell and few
// cells per triangle [1].
constexpr double kCellPerTriangle = 1.0;
// Limit on the number of cells, for surfaces with a few huge triangles. Design choice.
constexpr double kMostCells = 4e6;

// A point nearer to the plane of a triangle than this share of the size is in it. Design choice: above the rounding
// error of coordinates that are a hundred times as large, and far below a nanometre [1].
constexpr double kInPlane = 1e-12;

/// Six times the signed volume of a tetrahedron [m^3].
double volumeOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

std::array<Eigen::Vector3d, 3> cornersOf(const SurfaceView& wall, int triangle) {
  const auto& corner = wall.triangles[static_cast<std::size_t>(triangle)];
  return {wall.position(corner[0]), wall.position(corner[1]), wall.position(corner[2])};
}

bool shareVertex(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  for (const int v : a)
    if (v == b[0] || v == b[1] || v == b[2]) return true;
  return false;
}

}  // namespace

bool segmentPierces(const Eigen::Vector3d& begin, const Eigen::Vector3d& end,
                    const std::array<Eigen::Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const double rounding = kInPlane * (b - a).norm() * (c - a).norm() * (end - begin).norm();
  const double from = volumeOf(a, b, c, begin), to = volumeOf(a, b, c, end);
  if (!(std::min(from, to) < -rounding && std::max(from, to) > rounding)) return false;
  const double ab = volumeOf(begin, end, a, b), bc = volumeOf(begin, end, b, c), ca = volumeOf(begin, end, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

bool trianglesCross(const std::array<Eigen::Vector3d, 3>& a, const std::array<Eigen::Vector3d, 3>& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (segmentPierces(a[k], a[next], b) || segmentPierces(b[k], b[next], a)) return true;
  }
  return false;
}

const std::vector<WallCrossings::Pair>& WallCrossings::find(const SurfaceView& wall) {
  found_.clear();
  findBoxes(wall);
  if (!fillCells()) return found_;
  for (int z = 0; z < cells_.z(); ++z)
    for (int y = 0; y < cells_.y(); ++y)
      for (int x = 0; x < cells_.x(); ++x) {
        const auto cell = static_cast<std::size_t>(numberOf({x, y, z}));
        tryCell(wall, begin_[cell], begin_[cell + 1], {x, y, z});
      }
  std::sort(found_.begin(), found_.end());
  return found_;
}

void WallCrossings::findBoxes(const SurfaceView& wall) {
  boxes_.resize(wall.triangles.size());
  for (std::size_t t = 0; t < boxes_.size(); ++t) {
    const auto corners = cornersOf(wall, static_cast<int>(t));
    boxes_[t].low = corners[0].array().min(corners[1].array()).min(corners[2].array());
    boxes_[t].high = corners[0].array().max(corners[1].array()).max(corners[2].array());
  }
}

// @returns false without triangles, or if a position is not finite
bool WallCrossings::fillCells() {
  if (boxes_.empty()) return false;
  Eigen::Array3d low = boxes_.front().low, high = boxes_.front().high;
  double size = 0;
  for (const Box& box : boxes_) {
    low = low.min(box.low), high = high.max(box.high);
    size += (box.high - box.low).mean() / static_cast<double>(boxes_.size());
  }
  if (!std::isfinite(size) || size == 0) return false;
  origin_ = low;
  cell_size_ = std::max(kCellPerTriangle * 2 * size, math::cbrt((high - low + size).prod() / kMostCells));
  cells_ = ((high - low) / cell_size_).cast<int>() + 1;
  begin_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
  const auto forEachCell = [&](const auto& visit) {
    for (std::size_t t = 0; t < boxes_.size(); ++t) {
      const Eigen::Array3i first = cellOf(boxes_[t].low), last = cellOf(boxes_[t].high);
      for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
          for (int x = first.x(); x <= last.x(); ++x)
            visit(static_cast<std::size_t>(numberOf({x, y, z})), static_cast<int>(t));
    }
  };
  forEachCell([&](std::size_t cell, int) { ++begin_[cell + 1]; });
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  triangle_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<int> filled(begin_.begin(), begin_.end() - 1);
  forEachCell([&](std::size_t cell, int t) { triangle_[static_cast<std::size_t>(filled[cell]++)] = t; });
  return true;
}

Eigen::Array3i WallCrossings::cellOf(const Eigen::Array3d& place) const {
  return ((place - origin_) / cell_size_).cast<int>().max(0).min(cells_ - 1);
}

// A pair is tried in one cell only: that of the lower corner of what its boxes have in common.
void WallCrossings::tryCell(const SurfaceView& wall, int begin, int end, const Eigen::Array3i& cell) {
  for (int i = begin; i < end; ++i) {
    const int a = triangle_[static_cast<std::size_t>(i)];
    const Box& box = boxes_[static_cast<std::size_t>(a)];
    for (int j = i + 1; j < end; ++j) {
      const int b = triangle_[static_cast<std::size_t>(j)];
      const Box& other = boxes_[static_cast<std::size_t>(b)];
      const Eigen::Array3d low = box.low.max(other.low);
      if ((low > box.high.min(other.high)).any() || (cellOf(low) != cell).any()) continue;
      if (shareVertex(wall.triangles[static_cast<std::size_t>(a)], wall.triangles[static_cast<std::size_t>(b)]))
        continue;
      if (trianglesCross(cornersOf(wall, a), cornersOf(wall, b))) found_.push_back({std::min(a, b), std::max(a, b)});
    }
  }
}

}  // namespace vibe
