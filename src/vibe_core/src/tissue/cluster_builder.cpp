#include "tissue/cluster_builder.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr int kLanes = ClusterSet::kLanes;

// Neighbours of every vertex in counter-clockwise order seen from outside, starting at the smallest number.
std::vector<std::vector<int>> orderedRings(const SurfaceMesh& mesh) {
  std::vector<std::map<int, int>> next(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) next[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
  std::vector<std::vector<int>> rings(next.size());
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v].empty())
      throw Error("Vertex " + std::to_string(v) + " of the surface has no triangle; remove it from the mesh.");
    int member = next[v].begin()->first;
    do {
      rings[v].push_back(member);
      const auto found = next[v].find(member);
      if (found == next[v].end() || rings[v].size() > next[v].size())
        throw Error("Vertex " + std::to_string(v) +
                    " of the surface is not inside a closed ring of triangles; close the mesh.");
      member = found->second;
    } while (member != rings[v].front());
  }
  return rings;
}

// Clusters ordered by ring size, so that the eight lanes of a group need little padding.
std::vector<int> clusterOrder(const std::vector<std::vector<int>>& rings) {
  std::vector<int> order(rings.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rings[a].size() < rings[b].size(); });
  return order;
}

class Builder {
 public:
  Builder(const Organ& organ, const TissueScene& tissue, const std::vector<double>& masses,
          const std::vector<double>& areas)
      : organ_(organ), tissue_(tissue), masses_(masses), areas_(areas), rings_(orderedRings(organ.surface)) {}

  ClusterSet build() {
    const std::vector<int> order = clusterOrder(rings_);
    allocate(order);
    for (int lane = 0; lane < set_.group_count * kLanes; ++lane) {
      const bool padding = lane >= set_.particle_count;
      const int particle = order[std::min(lane, set_.particle_count - 1)];
      fillLane(lane, particle, padding);
      if (!padding) set_.lane_of_particle[particle] = lane;
    }
    listSlots();
    return std::move(set_);
  }

 private:
  void allocate(const std::vector<int>& order) {
    set_.particle_count = static_cast<int>(order.size());
    set_.group_count = (set_.particle_count + kLanes - 1) / kLanes;
    set_.row_offset.assign(1, 0);
    for (int g = 0; g < set_.group_count; ++g) {
      const int last = std::min((g + 1) * kLanes, set_.particle_count) - 1;
      set_.row_offset.push_back(set_.row_offset.back() + 1 + static_cast<int>(rings_[order[last]].size()));
    }
    const std::size_t slots = static_cast<std::size_t>(set_.rows()) * kLanes;
    const std::size_t lanes = static_cast<std::size_t>(set_.group_count) * kLanes;
    set_.particle.resize(slots);
    for (auto* v : {&set_.weight, &set_.rest_x, &set_.rest_y, &set_.rest_z}) v->assign(slots, 0);
    for (auto* v : {&set_.gain, &set_.orientation_weight, &set_.rest_spread, &set_.cluster_mass, &set_.compliance})
      v->assign(lanes, 0);
    set_.lane_of_particle.resize(order.size());
    moved_by_.resize(order.size());
  }

  void fillLane(int lane, int centre, bool padding) {
    const std::vector<int>& ring = rings_[centre];
    // relative to the centre, as in the kernel: avoids round-off far from the origin
    const Eigen::Vector3d& origin = organ_.surface.vertices[centre];
    double mass = masses_[centre];
    Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
    for (int member : ring) {
      mass += masses_[member];
      centre_of_mass += masses_[member] * (organ_.surface.vertices[member] - origin);
    }
    centre_of_mass /= mass;
    double spread = 0;
    const int group = lane / kLanes;
    const int rows = set_.row_offset[group + 1] - set_.row_offset[group];
    for (int row = 0; row < rows; ++row) {
      const int slot = (set_.row_offset[group] + row) * kLanes + lane % kLanes;
      const bool real = row <= static_cast<int>(ring.size());
      const int member = row == 0 ? centre : (real ? ring[row - 1] : ring.back());
      set_.particle[slot] = member;
      const Eigen::Vector3d r = organ_.surface.vertices[member] - origin - centre_of_mass;
      set_.rest_x[slot] = r.x();
      set_.rest_y[slot] = r.y();
      set_.rest_z[slot] = r.z();
      if (!real) continue;
      set_.weight[slot] = masses_[member] / mass;
      spread += set_.weight[slot] * r.squaredNorm();
      if (!padding) moved_by_[member].push_back(slot);
    }
    setMaterial(lane, centre, mass, spread);
  }

  void setMaterial(int lane, int centre, double mass, double spread) {
    const double thickness = organ_.thickness[centre];
    const double modulus = tissue_.young_modulus * thickness / (1 - tissue_.poisson_ratio);  // of dilation [N/m]
    set_.cluster_mass[lane] = mass;
    set_.rest_spread[lane] = spread;
    set_.compliance[lane] = mass * spread / (2 * modulus * areas_[centre]);
    // second moment of a plate about its mid-surface, t^2 / 12 per mass
    set_.orientation_weight[lane] = thickness * thickness / 12;
  }

  void listSlots() {
    set_.slot_offset.assign(1, 0);
    for (std::vector<int>& slots : moved_by_) {
      std::sort(slots.begin(), slots.end());
      set_.slot.insert(set_.slot.end(), slots.begin(), slots.end());
      set_.slot_offset.push_back(static_cast<int>(set_.slot.size()));
    }
  }

  const Organ& organ_;
  const TissueScene& tissue_;
  const std::vector<double>& masses_;
  const std::vector<double>& areas_;
  std::vector<std::vector<int>> rings_;
  std::vector<std::vector<int>> moved_by_;
  ClusterSet set_;
};

}  // namespace

ClusterSet buildClusters(const Organ& organ, const TissueScene& tissue, const std::vector<double>& masses,
                         const std::vector<double>& areas) {
  return Builder(organ, tissue, masses, areas).build();
}

namespace {

// For the cluster of a particle: the largest number of clusters that one of its members belongs to.
int maxClusters(const ClusterSet& set, int lane) {
  const int group = lane / kLanes;
  int max = 1;
  for (int row = set.row_offset[group]; row < set.row_offset[group + 1]; ++row) {
    const int member = set.particle[row * kLanes + lane % kLanes];
    max = std::max(max, set.slot_offset[member + 1] - set.slot_offset[member]);
  }
  return max;
}

double maxTotalGain(double substep, double stiffness_damping) {
  return kMaxTotalGain / (1 + 2 * stiffness_damping / substep);
}

}  // namespace

double setGains(ClusterSet& set, double substep, double stiffness_damping) {
  double worst = 1;
  for (int i = 0; i < set.particle_count; ++i) {
    const int lane = set.lane_of_particle[i];
    const double asked = substep * substep / set.compliance[lane];
    const double limit = maxTotalGain(substep, stiffness_damping) / maxClusters(set, lane);
    set.gain[lane] = std::min(asked, limit);
    set.compliance[lane] = substep * substep / set.gain[lane];
    worst = std::min(worst, set.gain[lane] / asked);
  }
  return worst;
}

int fewestSubsteps(const ClusterSet& set, double step_period, double stiffness_damping) {
  double stiffest = 0;  // [1/s^2]
  for (int i = 0; i < set.particle_count; ++i) {
    const int lane = set.lane_of_particle[i];
    stiffest = std::max(stiffest, maxClusters(set, lane) / set.compliance[lane]);
  }
  int substeps = 1;
  for (double h = step_period; h * h * stiffest > maxTotalGain(h, stiffness_damping); h = step_period / substeps)
    ++substeps;
  return substeps;
}

}  // namespace vibe
