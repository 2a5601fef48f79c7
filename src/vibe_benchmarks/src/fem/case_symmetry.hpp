#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fem/case_model.hpp"

namespace vibe::benchmarks {

/// Tells whether an equilibrium has buckled away from the branch that starts at rest. The answer to a small load is
/// unique, so it has every symmetry that the body, its supports and its loads have together. The branch that goes on
/// from there keeps them; where it loses its stability to a mode that breaks one, another branch without it begins (a
/// pitchfork). Mirror planes across the axes through the middle of the body are considered. A branch that keeps all
/// symmetries, as after snap-through, is not recognised.
class CaseSymmetry {
 public:
  /// Solves the case with a hundredth of its first load.
  explicit CaseSymmetry(const CaseModel& model);

  bool known() const;  ///< whether the case has a plane of symmetry
  /// The axis (0 to 2) of a plane of symmetry of the case that the motion has lost. What is less than the answer to the
  /// small load, as after the way back to rest, is no motion.
  std::optional<std::size_t> lost(const MotionView& motion) const;

 private:
  struct Pair {
    int node;
    NodeMean image;  // of its mirror image
  };
  using Field = std::vector<Eigen::Vector3d>;

  /// Norms of the part of the displacement that is odd in the mirror plane across an axis, and of all; a rigid motion
  /// of a body that floats counts in neither [m].
  struct Parts {
    double odd, all;
  };

  std::vector<Pair> pairsAcross(int axis) const;
  Parts partsOf(std::size_t axis, const MotionView& motion) const;
  void removeRigidMotion(const std::vector<Pair>& pairs, Field& field) const;

  const CaseModel& model_;
  bool floats_ = true;
  std::array<std::vector<Pair>, 3> pairs_;  // empty: the shape has no such plane
  std::array<bool, 3> has_{};
  double least_ = 0;  // displacement that counts [m]
};

}  // namespace vibe::benchmarks
