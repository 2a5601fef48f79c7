#include "constraints/grip_block.hpp"

#include "constraints/tool_yield.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

class GripBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    first_.clear();
    if (context.tool == nullptr) return Activity::Sleep;
    for (const GripPoint& point : context.state.grip) {
      node_[0] = point.particle;
      const Eigen::Vector3d target = context.tool->end[context.model.grip_link] * point.local;
      first_.push_back(loads.addPoint(node_, weight_, target, 0));
      if (context.bend != nullptr) setYield(context, target, loads);
    }
    return context.state.grip.empty() ? Activity::Sleep : Activity::Disturb;
  }

  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>& touches) override {
    const int link = context.model.grip_link;
    for (std::size_t g = 0; g < first_.size(); ++g) {
      const GripPoint& point = context.state.grip[g];
      ToolTouch touch;
      touch.kind = ToolTouch::Kind::Grip;
      touch.surface = SurfacePoint::ofNode(point.particle);
      touch.link = link;
      touch.point = context.tool->end[link] * point.local;
      touch.motion = touch.point - context.tool->start[link] * point.local;
      touch.force = loads.pointForce(first_[g]);
      touch.work = loads.pointWork(first_[g]);
      touch.direction = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
      touch.direction_count = 3;
      touches.push_back(touch);
    }
    return 0;
  }

 private:
  void setYield(const StepContext& context, const Eigen::Vector3d& target, BodyLoads& loads) const {
    const auto yield = toolYield(context, context.model.grip_link, target);
    for (int k = 0; k < 3; ++k)
      loads.constraints[first_.back() + static_cast<std::size_t>(k)].yield = yield.row(k).transpose();
  }

  std::vector<std::size_t> first_;  // constraint of each held particle
  std::vector<int> node_{0};
  std::vector<double> weight_{1};
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeGripBlock(const Model& model) {
  return model.tool ? std::make_unique<GripBlock>() : nullptr;
}

}  // namespace vibe
