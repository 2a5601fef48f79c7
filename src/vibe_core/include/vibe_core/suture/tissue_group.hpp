#pragma once
#include <Eigen/Core>
#include <vector>

namespace vibe {

/// The particles that a suture set draws to the middle of its bites. This is the tissue pulling of the ViBE prototype
/// (section 2.1.3 of its paper) formulated as a force: a spring pulls each particle to its target, and the reaction
/// acts on the bites, so the net force on the organ is zero. The middle is the mean of the bites at the start of
/// cinching and moves with them.
struct TissueGroup {
  std::vector<int> particle;            ///< ascending
  std::vector<Eigen::Vector3d> offset;  ///< from the middle at the start of cinching, rotated with the set since [m]
  std::vector<int> middle;              ///< particles whose weighted mean is the middle
  std::vector<double> weight;           ///< of these particles, sum 1
  double drawn = 0;                     ///< completed fraction of the way to the middle, 0 to 1

  bool empty() const { return particle.empty(); }
};

}  // namespace vibe
