#include "constraints/thread_block.hpp"

#include "constraints/cinching.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

class ThreadBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    first_ = loads.threads.size();
    sutures_.clear();
    const std::vector<Suture>& sutures = context.state.procedure.sutures;
    for (std::size_t s = 0; s < sutures.size(); ++s) {
      if (!sutures[s].pulls()) continue;
      addSuture(*context.model.scene.suture, sutures[s], loads);
      sutures_.push_back(s);
    }
    return isCinching(context.state) ? Activity::Wake : Activity::Sleep;
  }

  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>&) override {
    for (std::size_t t = 0; t < sutures_.size(); ++t) {
      Suture& suture = context.state.procedure.sutures[sutures_[t]];
      suture.length = loads.threads[first_ + t].length;
      suture.tension = loads.threads[first_ + t].tension;
      context.state.energy.thread_work += loads.threads[first_ + t].work;
    }
    return 0;
  }

 private:
  static void addSuture(const SutureScene& scene, const Suture& suture, BodyLoads& loads) {
    ThreadLoad& thread = loads.threads.add();
    thread.first_attachment = static_cast<int>(loads.attachments.size());
    thread.length = suture.length;
    thread.tension = suture.tension;
    thread.tension.resize(suture.length.size(), 0.0);
    thread.stiffness = scene.thread_stiffness;
    thread.friction = scene.thread_friction;
    for (const Bite& bite : suture.bites) {
      AttachmentPoint& attachment = loads.attachments.add();
      attachment.node = bite.particle;
      attachment.weight = bite.weight;
    }
  }

  std::size_t first_ = 0;             // of its threads in the loads
  std::vector<std::size_t> sutures_;  // of each thread
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeThreadBlock(const Model& model) {
  const auto& suture = model.scene.suture;
  return suture && suture->cinch_model == "thread" ? std::make_unique<ThreadBlock>() : nullptr;
}

}  // namespace vibe
