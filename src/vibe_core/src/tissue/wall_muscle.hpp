#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// The circular muscle of a stomach and its contraction waves: they arise at mid corpus, one in every period, and run
/// to the pylorus, getting faster, as deep everywhere beyond the proximal antrum and narrower on the way. Numbers with
/// sources are in the section `motion` of scenes. Constant.
class WallMuscle {
 public:
  /// @throws Error for an organ without an axis from fundus to pylorus
  WallMuscle(const MotionScene& scene, const Organ& organ);

  /// Per triangle the direction around the organ in which its muscle shortens; 0: it has none. Unit vectors.
  const std::vector<Eigen::Vector3d>& directions() const { return directions_; }

  /// Per node how much longer the muscle would be if it relaxed, over its length, as ShellElements takes it (ratio).
  /// The waves grow from none over the first seconds.
  /// @param time  simulated [s]
  /// @param out   (stride * nodes) of node i at stride * i; nodes without muscle are left as they are
  void contraction(double time, float* out, std::size_t stride = 1) const;

 private:
  struct Node {
    int number;
    double arrival;     // of the crest of the first wave [s]
    double half;        // of the time that a wave takes to pass [s]
    double shortening;  // at the crest (ratio)
  };

  double period_;            // [s]
  std::vector<Node> nodes_;  // with muscle
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace vibe
