#pragma once

#include <array>

#include "vibe_core/scene/scene.hpp"
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// The springs of ScopeSprings during one step of length h: the mean load of the step is that of
///   K (q + (theta + t/h) d),
/// with q at the start and d the change of the displacement. With theta 1/2 the error is of second order in h; where
/// the springs relax faster than within h/2, theta is 1 - t/h, so that they do not overshoot.
class ScopeSpringStep {
 public:
  /// @param stiffness        K, per degree of freedom
  /// @param force            of the springs along the insertion, see ScopeSprings::configurationalForce() [N]
  /// @param relaxation_time  t [s]
  /// @param from             q
  ScopeSpringStep(const YieldVector& stiffness, double force, double relaxation_time, const ToolDisplacement& from,
                  double step);

  /// Compliance of the tool. Its motions are counted from the displacement at the start of the step.
  ToolYield yield() const;
  /// What springs and dampers carry, as a mean over a step to another displacement, positive if the hand pushes the
  /// tool forward.
  YieldVector load(const ToolDisplacement& to) const;
  /// Dissipated by the springs' dampers (and by a theta above 1/2) in that step [J].
  double loss(const ToolDisplacement& to) const;
  /// theta + t/h: the load that a motion takes, over that which stays of it.
  double damped() const { return implicit_ + damping_; }

 private:
  YieldVector stiffness_;
  double force_, damping_, implicit_;
  ToolDisplacement from_;
};

/// The springs between the hand and the tip of an endoscope that gives way: the insertion tube along its axis and in
/// torsion, the wires of the bending section, and the shaft inside the lumen as a beam clamped at the entry (bending
/// energy EI/2 times the integral of the squared curvature). All are linear in the ToolDisplacement q, with stiffness
/// K, and relax together (Kelvin and Voigt): the load of the tissue on the tool is balanced by K (q + t dq/dt). The
/// shaft has no inertia; ScopeSpringStep says how q changes within a step.
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

  /// The springs during a step.
  /// @param joints  of the hand, in the middle of the step
  /// @param from    displacement at the start
  /// @param middle  displacement that is expected in the middle: stiffness and time constant are those there
  ScopeSpringStep during(const std::array<double, kJointCount>& joints, const ToolDisplacement& from,
                         const ToolDisplacement& middle, double step) const;

 private:
  const ToolModel* tool_;
  ScopeComplianceScene scene_;
};

}  // namespace vibe
