#include "constraints/pull_spring_block.hpp"

#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

class PullSpringBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    const PullSpring& pull = context.state.pull;
    if (!pull.holds()) return Activity::Sleep;
    first_ = loads.addPoint(pull.node, pull.weight, pull.target, 1 / kPullStiffness);
    return Activity::Disturb;
  }

  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>&) override {
    PullSpring& pull = context.state.pull;
    if (!pull.holds()) return 0;
    pull.force = loads.pointForce(first_);
    context.state.energy.pull_work += loads.pointWork(first_);
    return 0;
  }

  void recover(const StepContext& context) override {
    context.state.pull.target = heldPosition(context.state);
    context.state.pull.force.setZero();
  }

 private:
  std::size_t first_ = 0;  // of its constraints
};

}  // namespace

std::unique_ptr<ConstraintBlock> makePullSpringBlock(const Model&) {
  return std::make_unique<PullSpringBlock>();
}

}  // namespace vibe
