#include "constraints/thread_block.hpp"

#include "constraints/cinching.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

Eigen::Vector3d positionOf(const AttachmentPoint& attachment, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < attachment.node.size(); ++i) {
    const int p = attachment.node[i];
    sum += attachment.weight[i] * Eigen::Vector3d(state.x[p], state.y[p], state.z[p]);
  }
  return sum;
}

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
    measure(loads, context.state, start_lengths_);
    return isCinching(context.state) ? Activity::Wake : Activity::Sleep;
  }

  void store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>&) override {
    measure(loads, context.state, end_lengths_);
    context.state.energy.thread_work += work(loads, context.state);
    for (std::size_t t = 0; t < sutures_.size(); ++t) {
      Suture& suture = context.state.procedure.sutures[sutures_[t]];
      suture.length = loads.threads[first_ + t].length;
      suture.tension = loads.threads[first_ + t].tension;
    }
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

  // Distances between the bites of all sutures, segment by segment [m].
  void measure(const BodyLoads& loads, const State& state, std::vector<double>& lengths) const {
    lengths.clear();
    for (std::size_t t = 0; t < sutures_.size(); ++t) {
      const ThreadLoad& thread = loads.threads[first_ + t];
      for (std::size_t k = 0; k < thread.length.size(); ++k) {
        const std::size_t attachment = static_cast<std::size_t>(thread.first_attachment) + k;
        lengths.push_back(
            (positionOf(loads.attachments[attachment + 1], state) - positionOf(loads.attachments[attachment], state))
                .norm());
      }
    }
  }

  // Of the threads on the tissue, with the mean of the tensions before (state) and after (loads) the step [J].
  double work(const BodyLoads& loads, const State& state) const {
    double sum = 0;
    std::size_t segment = 0;
    for (std::size_t t = 0; t < sutures_.size(); ++t) {
      const Suture& suture = state.procedure.sutures[sutures_[t]];
      const ThreadLoad& thread = loads.threads[first_ + t];
      for (std::size_t k = 0; k < thread.tension.size(); ++k, ++segment) {
        const double old = k < suture.tension.size() ? suture.tension[k] : 0;
        sum -= 0.5 * (old + thread.tension[k]) * (end_lengths_[segment] - start_lengths_[segment]);
      }
    }
    return sum;
  }

  std::size_t first_ = 0;                            // of its threads in the loads
  std::vector<std::size_t> sutures_;                 // of each thread
  std::vector<double> start_lengths_, end_lengths_;  // per segment, at the start and at the end of the step [m]
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeThreadBlock(const Model& model) {
  const auto& suture = model.scene.suture;
  return suture && suture->cinch_model == "thread" ? std::make_unique<ThreadBlock>() : nullptr;
}

}  // namespace vibe
