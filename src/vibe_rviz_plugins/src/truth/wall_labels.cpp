#include "truth/wall_labels.hpp"

#include <algorithm>
#include <cmath>

#include "truth/label_table.hpp"

namespace vibe::rviz_plugins {
namespace {

/// Calls `use(particle, weight)` for the particles that carry a vertex.
template <class Use>
void forCarriers(const TissueMesh& mesh, std::size_t vertex, Use use) {
  if (!mesh.subdivided()) return use(static_cast<std::uint32_t>(vertex), 1.0F);
  for (std::uint32_t k = mesh.render_offsets[vertex]; k < mesh.render_offsets[vertex + 1]; ++k)
    use(mesh.render_particles[k], mesh.render_weights[k]);
}

/// The number with the largest share among the particles that carry a vertex; -1 if none is known.
std::int8_t prevailing(const TissueMesh& mesh, std::size_t vertex, const std::vector<std::uint8_t>& numbers,
                       int count) {
  std::array<float, kRegions> share{};
  if (numbers.empty()) return -1;
  forCarriers(mesh, vertex, [&](std::uint32_t particle, float weight) {
    if (numbers[particle] < count) share[numbers[particle]] += weight;
  });
  const auto largest = std::max_element(share.begin(), share.end());
  return *largest > 0 ? static_cast<std::int8_t>(largest - share.begin()) : std::int8_t{-1};
}

/// The label of a wall with heat, from that without.
std::uint8_t hotLabel(std::uint8_t cold, int heat) {
  const int step = cold >= kLabelPlainWall ? 1 : kRegions * kWalls;
  return static_cast<std::uint8_t>(cold + step * std::min(heat, kHeats - 1));
}

}  // namespace

void WallLabels::setMesh(const TissueMesh& mesh) {
  cold_.resize(mesh.vertex_count);
  for (std::size_t v = 0; v < mesh.vertex_count; ++v)
    cold_[v] = wallLabel(prevailing(mesh, v, mesh.region, kRegions), prevailing(mesh, v, mesh.wall, kWalls), 0);
  grade_.clear(), heat_.clear();
}

void WallLabels::setFrame(const TissueMesh& mesh, const TissueFrame& frame) {
  if (frame.grade == grade_) return;  // burns are rare
  grade_ = frame.grade;
  const bool cold = std::all_of(grade_.begin(), grade_.end(), [](std::uint8_t grade) { return grade == 0; });
  heat_.assign(cold ? 0 : mesh.vertex_count, 0.0F);
  for (std::size_t v = 0; v < heat_.size(); ++v)
    forCarriers(mesh, v, [&](std::uint32_t particle, float weight) {
      heat_[v] += weight * static_cast<float>(grade_[particle]);
    });
}

std::uint8_t WallLabels::at(const std::uint32_t* corner, const std::array<float, 3>& weight) const {
  std::size_t nearest = weight[1] > weight[0] ? 1 : 0;
  if (weight[2] > weight[nearest]) nearest = 2;
  const std::uint8_t cold = cold_[corner[nearest]];
  if (heat_.empty()) return cold;
  float heat = 0;
  for (std::size_t k = 0; k < 3; ++k) heat += weight[k] * heat_[corner[k]];
  return hotLabel(cold, static_cast<int>(std::lround(heat)));
}

}  // namespace vibe::rviz_plugins
