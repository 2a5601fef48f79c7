#include "vibe_render/geometry/fold_height.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vibe::render {
namespace {

/// The unit direction in which the angle around the organ grows, in a triangle at rest; zero where it is not defined.
Eigen::Vector3f directionAround(const MucosaVertex* const corner[3], const Eigen::Vector3f& ab,
                                const Eigen::Vector3f& ac) {
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  for (int k = 0; k < 3; ++k) mean += Eigen::Vector2f(corner[k]->around[0], corner[k]->around[1]) / 3;
  if (mean.norm() < 0.5F) return Eigen::Vector3f::Zero();
  const auto turned = [&](int k) { return mean[0] * corner[k]->around[1] - mean[1] * corner[k]->around[0]; };
  const Eigen::Vector3f normal = ab.cross(ac);
  // gradient of a linear function on a triangle, times the square of its doubled area
  const Eigen::Vector3f gradient =
      (turned(1) - turned(0)) * ac.cross(normal) + (turned(2) - turned(0)) * normal.cross(ab);
  const float length = gradient.norm();
  return length > 0 ? Eigen::Vector3f(gradient / length) : Eigen::Vector3f::Zero();
}

}  // namespace

float foldHeight(float stretch, float smooth) {
  const float spare = (smooth - stretch) / (smooth - 1);
  return spare > 0 ? std::min(kTallestFold, kRestingFold * std::sqrt(spare)) : 0;
}

FoldHeight::FoldHeight(const TissueMesh& mesh, const MucosaMap& map)
    : smooth_(map.smooth_stretch),
      render_offsets_(mesh.render_offsets),
      render_particles_(mesh.render_particles),
      render_weights_(mesh.render_weights) {
  area_.assign(mesh.particle_count, 0);
  stretch_.assign(mesh.particle_count, 1);
  of_particle_.assign(mesh.particle_count, 0);
  heights_.assign(mesh.vertex_count, 0);
  for (const MucosaVertex& particle : map.of_particle) folded_.push_back(std::max(0.0F, particle.folded));
  const std::vector<float>& rest = mesh.particle_rest;
  for (std::size_t t = 0; t + 2 < mesh.particle_triangles.size(); t += 3) {
    const std::uint32_t* corner = &mesh.particle_triangles[t];
    const auto place = [&](int k) { return Eigen::Vector3f(&rest[3 * corner[k]]); };
    const MucosaVertex* const entries[3] = {&map.of_particle[corner[0]], &map.of_particle[corner[1]],
                                            &map.of_particle[corner[2]]};
    const Eigen::Vector3f ab = place(1) - place(0), ac = place(2) - place(0);
    const Eigen::Vector3f around = directionAround(entries, ab, ac);
    Eigen::Matrix2f gram;
    gram << ab.dot(ab), ab.dot(ac), ab.dot(ac), ac.dot(ac);
    const Eigen::Vector2f parts = gram.inverse() * Eigen::Vector2f(ab.dot(around), ac.dot(around));
    const float area = 0.5F * ab.cross(ac).norm();
    if (!(area > 0) || !parts.allFinite()) continue;  // a triangle without area has no stretch
    const bool directed = around.squaredNorm() > 0.5F;
    strips_.push_back({{corner[0], corner[1], corner[2]}, parts[0], parts[1], directed ? 1.0F : 0.0F, area});
    for (int k = 0; k < 3; ++k) area_[corner[k]] += area;
  }
}

const std::vector<float>& FoldHeight::update(const std::vector<float>& positions) {
  std::fill(stretch_.begin(), stretch_.end(), 0.0F);
  for (const Strip& strip : strips_) {
    const Eigen::Vector3f a(&positions[3 * strip.corner[0]]);
    const Eigen::Vector3f ab = Eigen::Vector3f(&positions[3 * strip.corner[1]]) - a;
    const Eigen::Vector3f ac = Eigen::Vector3f(&positions[3 * strip.corner[2]]) - a;
    const float stretch = strip.directed > 0 ? (strip.along_first * ab + strip.along_second * ac).norm()
                                             : std::sqrt(0.5F * ab.cross(ac).norm() / strip.area);
    for (const std::uint32_t corner : strip.corner) stretch_[corner] += strip.area * stretch;
  }
  for (std::size_t i = 0; i < stretch_.size(); ++i) {
    stretch_[i] = area_[i] > 0 ? stretch_[i] / area_[i] : 1;
    of_particle_[i] = folded_[i] * foldHeight(stretch_[i], smooth_[i]);
  }
  if (render_offsets_.empty()) return of_particle_;
  for (std::size_t v = 0; v < heights_.size(); ++v) {
    float height = 0;
    for (std::uint32_t k = render_offsets_[v]; k < render_offsets_[v + 1]; ++k)
      height += render_weights_[k] * of_particle_[render_particles_[k]];
    heights_[v] = std::max(height, 0.0F);
  }
  return heights_;
}

}  // namespace vibe::render
