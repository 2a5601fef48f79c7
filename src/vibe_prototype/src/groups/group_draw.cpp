#include "groups/group_draw.hpp"

#include <algorithm>
#include <cmath>

#include "constraints/cinching.hpp"
#include "groups/index_groups.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::prototype {

namespace {

// Of the mean side of a triangle: rays between particles that are evenly spread meet them.
constexpr double kRayRadius = 0.6;

double meanSide(const SurfaceMesh& surface, const State& state) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += (particleAt(t[(k + 1) % 3], state) - particleAt(t[k], state)).norm();
  return sum / (3 * static_cast<double>(surface.triangles.size()));
}

bool holds(const TissueGroup& group, int particle) {
  return std::binary_search(group.particle.begin(), group.particle.end(), particle);
}

}  // namespace

void findGroup(const Model& model, const State& state, Suture& suture) {
  TissueGroup group;
  std::vector<Eigen::Vector3d> places;
  for (const Bite& bite : suture.bites) {
    places.push_back(bitePosition(bite, state.x, state.y, state.z));
    group.middle.insert(group.middle.end(), bite.particle.begin(), bite.particle.end());
    for (double w : bite.weight) group.weight.push_back(w / static_cast<double>(suture.bites.size()));
  }
  TechniqueResult technique;
  technique.technique = static_cast<Technique>(suture.technique);
  technique.transitions = suture.transitions;
  IndexGroupSettings settings;
  settings.ray_radius = kRayRadius * meanSide(model.organ.surface, state);
  settings.particle_limit = model.scene.suture->group_particles;
  settings.whole_legs = true;
  for (const auto& particles : indexGroups({state.x, state.y, state.z}, places, technique, settings))
    group.particle.insert(group.particle.end(), particles.begin(), particles.end());
  std::sort(group.particle.begin(), group.particle.end());
  const Eigen::Vector3d middle = middleOf(places);
  for (int i : group.particle) group.offset.emplace_back(particleAt(i, state) - middle);
  suture.group = std::move(group);
}

double groupStrain(const Model& model, const State& state, const TissueGroup& group) {
  const std::vector<Eigen::Vector3d>& rest = model.organ.surface.vertices;
  double max = 0;
  for (const auto& t : model.organ.surface.triangles) {
    if (!holds(group, t[0]) && !holds(group, t[1]) && !holds(group, t[2])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const double now = (particleAt(b, state) - particleAt(a, state)).norm();
      max = std::max(max, std::abs(now / (rest[b] - rest[a]).norm() - 1));
    }
  }
  return max;
}

double drawGroup(double amount, Suture& suture) {
  TissueGroup& group = suture.group;
  double farthest = 0;
  for (const Eigen::Vector3d& offset : group.offset) farthest = std::max(farthest, offset.norm());
  const double drawn = std::clamp((1 - group.drawn) * farthest, 0.0, amount);
  if (drawn > 0) group.drawn = std::min(1.0, group.drawn + drawn / farthest);
  suture.pulled += drawn;
  return drawn;
}

Eigen::Vector3d middleOf(const TissueGroup& group, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < group.middle.size(); ++k) sum += group.weight[k] * particleAt(group.middle[k], state);
  return sum;
}

void slackenGroup(const State& state, TissueGroup& group) {
  if (group.empty()) return;
  const Eigen::Vector3d middle = middleOf(group, state);
  for (std::size_t k = 0; k < group.particle.size(); ++k)
    group.offset[k] = particleAt(group.particle[k], state) - middle;
  group.drawn = 0;
}

}  // namespace vibe::prototype
