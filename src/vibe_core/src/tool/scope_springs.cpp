#include "vibe_core/tool/scope_springs.hpp"

#include <algorithm>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

ScopeSprings::ScopeSprings(const ToolModel& tool, const ScopeComplianceScene& scene) : tool_(&tool), scene_(scene) {}

YieldVector ScopeSprings::stiffness(double insertion) const {
  YieldVector k = YieldVector::Zero();
  k[Insertion] = scene_.axial_stiffness;
  k[Rotation] = scene_.torsional_rigidity / (scene_.outer_length + std::max(insertion, 0.0));
  k[TipUpDown] = k[TipLeftRight] = scene_.bending_stiffness;
  const double length = tool_->freeLength(insertion);
  if (tool_->shaftStations().empty() || length < stepPolicy().shaft_shortest_bend) return k;
  for (int direction = 0; direction < 2; ++direction) {
    const int dof = kShaftDof + 2 * direction;
    k[dof] = scene_.shaft_rigidity * length;
    k[dof + 1] = scene_.shaft_rigidity * length / 3;
  }
  return k;
}

double ScopeSprings::energy(const std::array<double, kJointCount>& joints, const ToolDisplacement& displacement) const {
  const YieldVector k = stiffness(joints[Insertion] + displacement[Insertion]);
  double sum = 0;
  for (int d = 0; d < kYieldDofs; ++d) sum += 0.5 * k[d] * displacement[d] * displacement[d];
  return sum;
}

double ScopeSprings::configurationalForce(const std::array<double, kJointCount>& joints,
                                          const ToolDisplacement& displacement) const {
  const double insertion = joints[Insertion] + displacement[Insertion];
  const YieldVector k = stiffness(insertion);
  const double twisted = scene_.outer_length + std::max(insertion, 0.0), length = tool_->freeLength(insertion);
  double force = 0.5 * k[Rotation] / twisted * displacement[Rotation] * displacement[Rotation];
  for (int d = kShaftDof; d < kYieldDofs; ++d)
    if (k[d] > 0) force -= 0.5 * k[d] / length * displacement[d] * displacement[d];
  return force;
}

// The way of the tip follows from the deflections of a straight scope: that of the shaft's end, its slope times the
// length of the bending section, and half that length times the bend.
double ScopeSprings::relaxationTime(const std::array<double, kJointCount>& joints,
                                    const ToolDisplacement& displacement) const {
  const double length = std::max(tool_->freeLength(joints[Insertion] + displacement[Insertion]), 0.0);
  const double reach = -tool_->freeLength(0);
  Eigen::Vector3d tip(displacement[Insertion], 0, 0);
  for (int direction = 0; direction < 2; ++direction) {
    const double mean = displacement[kShaftDof + 2 * direction], change = displacement[kShaftDof + 2 * direction + 1];
    tip[1 + direction] = mean * length * (length / 2 + reach) - change * length * length / 6 +
                         displacement[TipUpDown + direction] * reach / 2;
  }
  return std::max(scene_.relaxation_time, tip.norm() / stepPolicy().shaft_spring_back);
}

std::array<double, kJointCount> ScopeSprings::handMotion(const std::array<double, kJointCount>& start,
                                                         const std::array<double, kJointCount>& end,
                                                         const ToolDisplacement& displacement, double step) const {
  const YieldVector k = stiffness(start[Insertion] + displacement[Insertion]);
  const double damped = during(start, displacement, displacement, step).damped();
  std::array<double, kJointCount> result = end;
  for (int j = 0; j < kScopeJointCount; ++j) {
    const JointLimits& limits = tool_->limits()[j];
    // if the tool stays where it is, a motion m of the hand leaves K q - (theta + t/h) K m
    const double load = k[j] * displacement[j] / limits.effort, give = limits.effort / (k[j] * damped);
    // springs too stiff for that at the speed of a step: the nearer to its limit, the slower the hand
    const double way = std::max(give, limits.velocity * step);
    const double most = (1 + load) * (load > -1 ? way : give), least = -(1 - load) * (load < 1 ? way : give);
    result[j] = start[j] + std::clamp(end[j] - start[j], least, most);
  }
  return result;
}

ScopeSpringStep ScopeSprings::during(const std::array<double, kJointCount>& joints, const ToolDisplacement& from,
                                     const ToolDisplacement& middle, double step) const {
  return {stiffness(joints[Insertion] + middle[Insertion]), configurationalForce(joints, middle),
          relaxationTime(joints, middle), from, step};
}

ScopeSpringStep::ScopeSpringStep(const YieldVector& stiffness, double force, double relaxation_time,
                                 const ToolDisplacement& from, double step)
    : stiffness_(stiffness),
      force_(force),
      damping_(relaxation_time / step),
      implicit_(std::clamp(1 - damping_, 0.5, 1.0)),
      from_(from) {}

ToolYield ScopeSpringStep::yield() const {
  const double part = 1 / damped();
  ToolYield yield;
  yield.dofs = kYieldDofs;
  for (int d = 0; d < kYieldDofs; ++d) {
    if (stiffness_[d] > 0) yield.compliance(d, d) = part / stiffness_[d];
    yield.free[d] = -part * from_[d];
  }
  yield.free[Insertion] += yield.compliance(Insertion, Insertion) * force_;
  yield.displacement = yield.free;
  return yield;
}

YieldVector ScopeSpringStep::load(const ToolDisplacement& to) const {
  YieldVector load = stiffness_;
  for (int d = 0; d < kYieldDofs; ++d) load[d] *= -(from_[d] + damped() * (to[d] - from_[d]));
  return load;
}

double ScopeSpringStep::loss(const ToolDisplacement& to) const {
  double sum = 0;
  for (int d = 0; d < kYieldDofs; ++d)
    sum += (damped() - 0.5) * stiffness_[d] * (to[d] - from_[d]) * (to[d] - from_[d]);
  return sum;
}

}  // namespace vibe
