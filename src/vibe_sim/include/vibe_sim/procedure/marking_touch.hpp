#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_sim/contact/tool_collision.hpp"
#include "vibe_sim/model.hpp"
#include "vibe_sim/solver/solver.hpp"
#include "vibe_sim/state.hpp"
#include "vibe_sim/tissue/gradient_touch.hpp"

namespace vibe {

/// In place of the solver while the pedal is down (marking.deformation: gradient): the wall as it was when the pedal
/// went down gives way to the tool and to what the helix holds, see GradientTouch and its limits. Nothing has a speed,
/// threads do not pull, no force is felt, the insufflator pauses and the energy account stands still. When the pedal
/// comes up the solver goes on from the shape that is there.
///
/// Not used while a cinch draws thread or a lost wall is led home: both need the solver.
class MarkingTouch {
 public:
  /// @param model  with a tool; must outlive this
  explicit MarkingTouch(const Model& model);

  static bool mayReplaceSolver(const State& state);

  /// One step.
  /// @param link_poses  of the tool's links in world at the end of the step
  void follow(const std::vector<Eigen::Isometry3d>& link_poses, State& state, StepReport& report);

  /// Before a step of the solver: it takes the wall over where the gradient domain left it.
  static void handBack(State& state);

 private:
  void find(const std::vector<Eigen::Isometry3d>& link_poses, const State& state, const std::vector<double>& x,
            const std::vector<double>& y, const std::vector<double>& z, std::vector<Touch>& touches);

  const Model& model_;
  ToolCollision collision_;
  GradientTouch touch_;
};

}  // namespace vibe
