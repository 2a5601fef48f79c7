#pragma once
#include <Eigen/Core>
#include <vector>

namespace vibe {

/// The particles that a set draws to the middle of its bites, as the ViBE prototype pulls tissue (section 2.1.3 of its
/// paper), made a force: a spring from each of them to its place, and the reaction on the bites, so that a set pushes
/// the organ nowhere. The middle is the mean of the bites as they were when the cinch began, and moves with them.
struct TissueGroup {
  std::vector<int> particle;            ///< rising
  std::vector<Eigen::Vector3d> offset;  ///< from the middle when the cinch began, turned with the set since [m]
  std::vector<int> middle;              ///< particles whose weighted mean is the middle
  std::vector<double> weight;           ///< of them, sum 1
  double drawn = 0;                     ///< part of the way to the middle that is done, 0 to 1

  bool empty() const { return particle.empty(); }
};

}  // namespace vibe
