#include <algorithm>
#include <cmath>

#include "constraints/blocks.hpp"
#include "constraints/cinching.hpp"
#include "model/step_accounts.hpp"
#include "self_contact/self_contact.hpp"
#include "vibe_core/constraints/wall_contacts.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/solver/step_policy.hpp"
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

namespace {

class SelfContactBlock : public ConstraintBlock {
 public:
  explicit SelfContactBlock(const Model& model)
      : contact_(model.organ.surface, model.organ.thickness, model.scene.tissue.young_modulus,
                 breathingOf(model.scene).has_value()) {}

  Activity prepare(const StepContext&, BodyLoads&) override { return Activity::Sleep; }

  const EnergyTerm* energyTerm(const StepContext& context) override {
    detect(context);
    return &contact_;
  }

  // A step may end with walls that have passed through each other: iterations end early, tools jump.
  void correct(const StepContext& context) override {
    contact_.resolvePenetrations(viewOf(context.state), context.step);
  }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    measure(context);
    return 0;
  }

  void recover(const StepContext& context) override { measure(context); }

 private:
  void measure(const StepContext& context) {
    detect(context);
    context.state.energy.contact_energy = contact_.energy();
  }
  void detect(const StepContext& context) {
    // How far walls may approach each other in the step: a search with more finds too much, with less misses contacts.
    const StepPolicy& policy = stepPolicy();
    const double move = policy.wall_reach_per_move * context.step * std::sqrt(maxSpeedSquared(context.state));
    const TissueScene& tissue = context.model.scene.tissue;
    // Forces are evaluated 1 - alpha_f of the step after its start, and ahead by the damping time (time_scheme.hpp).
    const double lead = context.step / (1 + tissue.spectral_radius) + tissue.stiffness_damping;
    const State& s = context.state;
    contact_.detect({s.x.data(), s.y.data(), s.z.data()}, {s.vx.data(), s.vy.data(), s.vz.data()},
                    std::clamp(move, policy.wall_least_reach, context.model.particle_radius), lead, context.pool);
  }
  static MotionView viewOf(State& state) {
    return {{state.x.data(), state.y.data(), state.z.data()},
            {state.vx.data(), state.vy.data(), state.vz.data()},
            {state.ax.data(), state.ay.data(), state.az.data()}};
  }

  SelfContact contact_;
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeSelfContactBlock(const Model& model) {
  return model.scene.tissue.self_contact ? std::make_unique<SelfContactBlock>(model) : nullptr;
}

WallContacts::WallContacts(const Model& model) {
  const TissueScene& tissue = model.scene.tissue;
  if (tissue.self_contact)
    contact_ = std::make_unique<SelfContact>(model.organ.surface, model.organ.thickness, tissue.young_modulus);
}

WallContacts::~WallContacts() = default;

const std::vector<WallContact>& WallContacts::find(const State& state) {
  found_.clear();
  if (!contact_) return found_;
  contact_->detect({state.x.data(), state.y.data(), state.z.data()},
                   {state.vx.data(), state.vy.data(), state.vz.data()}, 0, 0);
  for (const SelfContact::Pair& pair : contact_->pairs()) {
    WallContact contact{pair.node, pair.weight, Eigen::Vector3d::Zero(), pair.normal, pair.away.norm(), 0};
    for (std::size_t k = 0; k < pair.node.size(); ++k) {
      const int i = pair.node[k];
      if (i >= 0) contact.point += 0.5 * std::abs(pair.weight[k]) * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
    }
    contact.force = contact_->normalForce(pair);
    found_.push_back(contact);
  }
  return found_;
}

}  // namespace vibe
