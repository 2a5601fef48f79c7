#include "groups/group_cinch.hpp"

#include "constraints/cinching.hpp"
#include "groups/group_draw.hpp"
#include "groups/group_pull.hpp"

namespace vibe::prototype {

namespace {

class GroupBlock : public ConstraintBlock, public SubstepLoad {
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

  SubstepLoad* substepLoad() override { return this; }
  void prepareSubsteps(const Model& model, State& state) override { groups_.prepare(model, state); }
  void apply(const Model& model, double substep, State& state) override { groups_.applySubstep(model, substep, state); }
  void reportSubsteps(int, State& state) override { groups_.report(state); }

 private:
  GroupPull groups_;
};

}  // namespace

void GroupCinch::begin(const Model& model, const State& state, Suture& suture) const {
  findGroup(model, state, suture);
}

double GroupCinch::draw(const Model& model, const State& state, double amount, Suture& suture) const {
  return groupStrain(model, state, suture.group) < model.scene.suture->strain_limit ? drawGroup(amount, suture) : 0;
}

void GroupCinch::slacken(const State& state, Suture& suture) const {
  slackenGroup(state, suture.group);
}

std::unique_ptr<ConstraintBlock> makeGroupBlock(const Model& model) {
  const auto& suture = model.scene.suture;
  return suture && suture->cinch_model == "groups" ? std::make_unique<GroupBlock>() : nullptr;
}

}  // namespace vibe::prototype
