#pragma once
#include <cstdint>
#include <vector>

namespace vibe {

struct Organ;

/// Shape-matching clusters in the layout of the kernel: every particle with its one-ring is a cluster. Eight clusters
/// of similar size make a group; a group has one row per member: row 0 is the centre, then the ring in
/// counter-clockwise order, short rings repeat their last member with weight 0. Arrays by slot are (rows * 8).
struct ClusterSet {
  static constexpr int kLanes = 8;
  int particle_count = 0;
  int group_count = 0;
  std::vector<std::int32_t> row_offset;        ///< first row of each group (group_count + 1)
  std::vector<std::int32_t> particle;          ///< member, by slot
  std::vector<double> weight;                  ///< mass over the cluster's mass [1], by slot
  std::vector<double> rest_x, rest_y, rest_z;  ///< member minus the cluster's centre of mass at rest [m], by slot
  std::vector<double> gain;                ///< fraction of the way to the goal taken per sub-step, (group_count * 8)
  std::vector<double> orientation_weight;  ///< of the centre's own orientation in the moment matrix [m^2], (.. * 8)
  std::vector<double> rest_spread;         ///< weighted mean square distance from the centre of mass [m^2], (.. * 8)
  std::vector<double> cluster_mass;        ///< [kg], (group_count * 8)
  std::vector<double> compliance;          ///< XPBD compliance alpha per mass, as simulated [s^2], (.. * 8)

  std::vector<std::int32_t> lane_of_particle;  ///< place of each particle's own cluster in the arrays by lane

  // which slots move a particle, ascending
  std::vector<std::int32_t> slot_offset;  ///< (particle_count + 1)
  std::vector<std::int32_t> slot;         ///< (slot_offset.back())

  int rows() const { return row_offset.back(); }
};

}  // namespace vibe
