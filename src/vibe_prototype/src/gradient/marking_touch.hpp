#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "gradient/gradient_touch.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/tool_collision.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::prototype {

/// Replaces the solver while the pedal is down (marking.deformation: gradient): the wall as it was when the pedal went
/// down is deformed by the tool and by the tissue that the helix holds, see GradientTouch and its limits. Meanwhile
/// velocities are zero, threads do not pull, the tool feels no force, the insufflator pauses and the energy account
/// does not change. When the pedal is released, the solver continues from the present shape. This shape is no
/// equilibrium of the solver, so its first steps are shortened until they are small by themselves.
///
/// Not used while a cinch draws thread, while the tissue is pulled, or during a recovery: these need the solver.
class MarkingTouch : public MarkingDeformation {
 public:
  /// @param model  with a tool; must outlive this
  explicit MarkingTouch(const Model& model);

  static bool mayReplaceSolver(const State& state);

  void advance(const ToolMotion& motion, bool pedal, const std::function<void()>& solve, State& state,
               StepReport& report) override;

 private:
  void update(const ToolMotion& motion, State& state, StepReport& report);
  /// One step of the solver from the shape that the gradient domain has left. No particle moves farther than 0.8 mm
  /// plus the motion of the tool.
  void handBack(const ToolMotion& motion, const std::function<void()>& solver_step, State& state);
  void limitStep(double farthest, State& state) const;
  void storeBase(State& state) const;
  void updateGas(State& state) const;
  void find(const State& state, const std::vector<double>& x, const std::vector<double>& y,
            const std::vector<double>& z, std::vector<Touch>& touches);

  const Model& model_;
  ToolCollision collision_;
  GradientTouch touch_;
  LinkPoses old_poses_, poses_;  // of the tool's links in world, before and after a step
};

}  // namespace vibe::prototype
