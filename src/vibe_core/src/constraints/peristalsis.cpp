#include "constraints/blocks.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

class PeristalsisBlock : public ConstraintBlock {
 public:
  explicit PeristalsisBlock(const ShellTissue& tissue)
      : tissue_(tissue),
        contraction_(tissue.elements()->mesh().nodes.size(), 0),
        displacement_(4 * contraction_.size()) {}

  // As long as a step lasts, the contraction is that of its end.
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    tissue_.muscle()->contraction(context.state.time + context.step, contraction_.data());
    loads.contraction = &contraction_;
    loads.driven = true;
    return Activity::Disturb;
  }

  // The muscle works before anything moves: by what the wall's energy then grows.
  void begin(const StepContext& context, BodyLoads&) override {
    tissue_.displacement4(context.state, displacement_);
    work_ = tissue_.elements()->muscleWork(displacement_.data(), contraction_.data());
    if (context.state.solver.elastic_energy >= 0) context.state.solver.elastic_energy += work_;
  }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    context.state.motion.muscle_work += work_;
    return 0;
  }

 private:
  const ShellTissue& tissue_;
  std::vector<float> contraction_;   // per node, at the end of the step (ratio)
  std::vector<float> displacement_;  // at its start (4 per node)
  double work_ = 0;                  // in this step [J]
};

}  // namespace

std::unique_ptr<ConstraintBlock> makePeristalsisBlock(const Model& model) {
  const auto* tissue = dynamic_cast<const ShellTissue*>(model.tissue.get());
  return tissue != nullptr && tissue->muscle() ? std::make_unique<PeristalsisBlock>(*tissue) : nullptr;
}

}  // namespace vibe
