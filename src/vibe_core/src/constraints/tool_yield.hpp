#pragma once

#include <Eigen/Core>

#include "vibe_core/constraints/constraint_block.hpp"

namespace vibe {

/// How a point on a link of the tool moves with the tool's displacement: ContactConstraint::yield, and its rows those
/// of LinearConstraint::yield. Zero with a rigid tool. It is that of the middle of the step, so that the work at the
/// joints is the work at the point to third order.
/// @param point  in world, at the poses context.tool->end [m]
Eigen::Matrix<double, 3, kYieldDofs> toolYield(const StepContext& context, int link, const Eigen::Vector3d& point);

}  // namespace vibe
