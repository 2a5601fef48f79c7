#include "contact/contact_check.hpp"

namespace vibe::benchmarks {

ContactCheck::ContactCheck(const Model& model) : model_(model) {
  for (const End end : model.organ.end) open_.push_back(end != End::None ? 1 : 0);
}

const std::vector<WallCrossings::Pair>& ContactCheck::wall(const State& state) {
  return wall_.find({model_.organ.surface.triangles, state.x, state.y, state.z});
}

ToolCrossing ContactCheck::tool(const State& state) {
  if (!model_.tool) return {};
  passes_ = open_;
  for (const GripPoint& point : state.grip) passes_[static_cast<std::size_t>(point.particle)] = 1;
  model_.tool->forwardKinematics(state.joints, state.tool_displacement, poses_);
  for (Eigen::Isometry3d& pose : poses_) pose = model_.tool_base * pose;
  return findToolCrossing(*model_.tool, poses_, {model_.organ.surface.triangles, state.x, state.y, state.z}, passes_);
}

}  // namespace vibe::benchmarks
