#include "constraints/tool_yield.hpp"

#include "contact/tool_jacobian.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe {

Eigen::Matrix<double, 3, kYieldDofs> toolYield(const StepContext& context, int link, const Eigen::Vector3d& point) {
  if (context.bend == nullptr) return Eigen::Matrix<double, 3, kYieldDofs>::Zero();
  const Eigen::Vector3d local = context.tool->end[link].inverse() * point;
  return yieldJacobian(*context.model.tool, context.tool->middle, *context.bend, link,
                       context.tool->middle[link] * local);
}

}  // namespace vibe
