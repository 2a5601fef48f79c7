#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "contact/tool_collision.hpp"
#include "contact/tool_motion.hpp"
#include "tissue/gradient_touch.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// In place of the solver while the pedal is down (marking.deformation: gradient): the wall as it was when the pedal
/// went down gives way to the tool and to what the helix holds, see GradientTouch and its limits. Nothing has a speed,
/// threads do not pull, no force is felt, the insufflator pauses and the energy account stands still. When the pedal
/// comes up the solver goes on from the shape that is there, which is none of its own: its first steps are shortened
/// until they are small by themselves.
///
/// Not used while a cinch draws thread or a lost wall is led home: both need the solver.
class MarkingTouch {
 public:
  /// @param model  with a tool; must outlive this
  explicit MarkingTouch(const Model& model);

  static bool mayReplaceSolver(const State& state);

  /// One step.
  void update(const ToolMotion& motion, State& state, StepReport& report);

  /// One step of the solver, which takes the wall over where the gradient domain has left it. No particle goes farther
  /// than 0.8 mm and the way of the tool.
  void handBack(const ToolMotion& motion, const std::function<void()>& solver_step, State& state);

 private:
  void limitStep(double farthest, State& state) const;
  void storeBase(State& state) const;
  void updateGas(State& state) const;
  void find(const State& state, const std::vector<double>& x, const std::vector<double>& y,
            const std::vector<double>& z, std::vector<Touch>& touches);

  const Model& model_;
  ToolCollision collision_;
  GradientTouch touch_;
  std::vector<Eigen::Isometry3d> old_poses_, poses_;  // of the tool's links in world, about a step
};

}  // namespace vibe
