#include "constraints/group_block.hpp"

#include "constraints/cinching.hpp"
#include "constraints/group_draw.hpp"
#include "constraints/group_pull.hpp"

namespace vibe {

namespace {

class GroupBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads&) override {
    return isCinching(context.state) ? Activity::Wake : Activity::Sleep;
  }

  const EnergyTerm* energyTerm(const StepContext& context) override {
    groups_.prepare(context.model, context.state);
    return groups_.count() > 0 ? &groups_ : nullptr;
  }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    const EnergyAccount& sum = context.state.energy;
    const double before = sum.pull_work + sum.thread_work;
    groups_.report(context.state);
    return sum.pull_work + sum.thread_work - before;
  }

  void recover(const StepContext& context) override {
    for (Suture& suture : context.state.procedure.sutures) slackenGroup(context.state, suture.group);
  }

 private:
  GroupPull groups_;
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeGroupBlock(const Model& model) {
  const auto& suture = model.scene.suture;
  return suture && suture->cinch_model == "groups" ? std::make_unique<GroupBlock>() : nullptr;
}

}  // namespace vibe
