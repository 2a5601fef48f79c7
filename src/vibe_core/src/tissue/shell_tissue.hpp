#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tissue/wall_muscle.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/tissue/shell.hpp"
#include "vibe_core/tissue/tissue_model.hpp"

namespace vibe {

/// Fibres of the wall of an organ. The long axis is that of a stomach (see findAxis); for an organ without an end at
/// the duodenum it is the line from fundus to pylorus.
/// @param factor  of the modulus, per triangle
/// @throws Error if the organ has no axis: fundus and pylorus coincide
ShellFibres wallFibres(const FibreScene& scene, const Organ& organ, const std::vector<double>& factor);

/// The wall of an organ as a shell whose nodes are the particles (tissue.model: shell).
class ShellTissue : public TissueModel {
 public:
  /// @param fixed   per particle: not 0 where it is held
  /// @param motion  empty: a wall without muscle
  /// @throws Error for an unknown tissue.law, and as ShellElements and WallMuscle
  ShellTissue(const TissueScene& tissue, const Organ& organ, const std::vector<char>& fixed,
              const std::optional<MotionScene>& motion = {});

  std::string name() const override { return "shell"; }
  double energy(const State& state) const override;
  void addForces(const State& state, double* fx, double* fy, double* fz) const override;
  void strain(const State& state, float* out) const override;
  double stiffnessRatio() const override { return 1; }

  std::shared_ptr<const ShellElements> elements() const { return elements_; }
  const std::optional<WallMuscle>& muscle() const { return muscle_; }  ///< empty: none contracts
  /// From rest, with the contraction at the state's time, as ShellElements takes them.
  /// @param out  (4 per particle) [m]
  void displacement4(const State& state, std::vector<float>& out) const;

 private:
  std::vector<double> displacement(const State& state) const;
  std::optional<WallMuscle> muscle_;  // before the elements, which have its directions
  double relaxing_share_;             // of the stress and energy of the law, see RelaxationScene
  std::shared_ptr<const ShellElements> elements_;
};

}  // namespace vibe
