#pragma once

#include <array>

#include "vibe_core/contact/tool_model.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// The springs between the hand and the tip of an endoscope that gives way: the insertion tube along its axis and in
/// torsion, the wires of the bending section, and the shaft inside the lumen as a beam clamped at the entry (bending
/// energy EI/2 times the integral of the squared curvature). All are linear in the ToolDisplacement q, with stiffness
/// K, and relax together (Kelvin and Voigt): the load of the tissue on the tool is balanced by K (q + t dq/dt). The
/// shaft has no inertia; within a step q changes by implicit Euler.
class ScopeSprings {
 public:
  /// @param tool  must outlive this object
  ScopeSprings(const ToolModel& tool, const ScopeComplianceScene& scene);

  /// Of each degree of freedom at an insertion that the tool really has; 0 where nothing bends. Units as
  /// ToolDisplacement: [N/m], [N m/rad], then [N m^3].
  YieldVector stiffness(double insertion) const;
  /// Stored in the springs [J].
  double energy(const std::array<double, kJointCount>& joints, const ToolDisplacement& displacement) const;
  /// Force of the springs along the insertion, because their stiffness changes with it: a bent beam that slides out of
  /// its clamp is pushed out by M^2 / (2 EI) (Bigoni et al. 2015, Mech. Mater. 80:368) [N].
  double configurationalForce(const std::array<double, kJointCount>& joints,
                              const ToolDisplacement& displacement) const;

  /// Time constant of the displacement, longer where the tip would spring back faster than a brisk hand moves [s].
  double relaxationTime(const std::array<double, kJointCount>& joints, const ToolDisplacement& displacement) const;

  /// Where a hand whose force is limited brings the joints, on the way from `start` to `end`: it stalls, or is pushed
  /// back, where the springs between it and the tool would carry more than JointLimits::effort. Springs so stiff that a
  /// step at full speed loads them beyond that may exceed it for a step.
  std::array<double, kJointCount> handMotion(const std::array<double, kJointCount>& start,
                                             const std::array<double, kJointCount>& end,
                                             const ToolDisplacement& displacement, double step) const;

  /// Compliance of the tool during a step. Its motions are counted from the displacement at the start of the step.
  /// @param joints  of the hand, at the end of the step
  ToolYield yield(const std::array<double, kJointCount>& joints, const ToolDisplacement& displacement,
                  double step) const;

  /// What the springs and their dampers carry at the end of a step from one displacement to another, positive if the
  /// hand pushes the tool forward.
  YieldVector load(const std::array<double, kJointCount>& joints, const ToolDisplacement& from,
                   const ToolDisplacement& to, double step) const;

  /// Dissipated by the springs' dampers (and by implicit Euler) in a step from one displacement to another [J].
  double loss(const std::array<double, kJointCount>& joints, const ToolDisplacement& from, const ToolDisplacement& to,
              double step) const;

 private:
  const ToolModel* tool_;
  ScopeComplianceScene scene_;
};

}  // namespace vibe
