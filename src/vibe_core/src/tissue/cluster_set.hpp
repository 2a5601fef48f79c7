#pragma once
#include <cstdint>
#include <vector>

namespace vibe {

struct Organ;

/// Shape-matching clusters in the layout of the kernel. Every particle with its one-ring is a cluster. Eight clusters
/// of similar size form a group. A group has one row per member: row 0 is the centre, then the ring in
/// counter-clockwise order; short rings repeat their last member with weight 0. Arrays by slot are (rows * 8).
struct ClusterSet {
  static constexpr int kLanes = 8;
  int particle_count = 0;
  int group_count = 0;
  std::vector<std::int32_t> row_offset;        ///< first row of each group (group_count + 1)
  std::vector<std::int32_t> particle;          ///< member, by slot
  std::vector<double> weight;                  ///< mass over the cluster's mass [1], by slot
  std::vector<double> rest_x, rest_y, rest_z;  ///< member minus the cluster's centre of mass at rest [m], by slot
  std::vector<double> gain;                    ///< fraction of the path to the goal per sub-step, (group_count * 8)
  std::vector<double> orientation_weight;  ///< weight of the centre's orientation in the moment matrix [m^2], (.. * 8)
  std::vector<double> rest_spread;         ///< weighted mean square distance from the centre of mass [m^2], (.. * 8)
  std::vector<double> cluster_mass;        ///< [kg], (group_count * 8)
  std::vector<double> compliance;          ///< XPBD compliance alpha per mass, as simulated [s^2], (.. * 8)

  std::vector<std::int32_t> lane_of_particle;  ///< index of each particle's own cluster in the arrays by lane

  // slots that move a particle, ascending
  std::vector<std::int32_t> slot_offset;  ///< (particle_count + 1)
  std::vector<std::int32_t> slot;         ///< (slot_offset.back())

  int rows() const { return row_offset.back(); }
};

}  // namespace vibe
