#include "constraints/tool_contact_block.hpp"

#include <algorithm>

#include "constraints/depenetration.hpp"
#include "constraints/tool_yield.hpp"
#include "contact/deepest_contact.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

// Particles that are predicted this near to the tool become contacts, because they may be reached within the step.
// Design choice: covers 0.12 m/s that the prediction from velocities does not foresee in a step of 1/60 s [m].
constexpr double kContactMargin = 2e-3;
// Share of the largest friction above which a contact counts as sliding. Design choice: the contact iterations stop
// within this of the cone [1].
constexpr double kSticks = 0.999;

class ToolContactBlock : public ConstraintBlock {
 public:
  explicit ToolContactBlock(const Model& model) : collision_(*model.tool) {
    for (auto* v : {&ahead_x_, &ahead_y_, &ahead_z_}) v->resize(static_cast<std::size_t>(model.particle_count));
  }

  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    first_ = loads.contacts.size();
    motion_.clear();
    link_.clear();
    if (context.tool == nullptr) return Activity::Sleep;
    lookAhead(context);
    findContacts(context, loads);
    return motion_.empty() ? Activity::Sleep : Activity::Disturb;
  }

  void store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>& touches) override {
    for (std::size_t c = 0; c < motion_.size(); ++c) {
      const ContactConstraint& contact = loads.contacts[first_ + c];
      if (contact.force.isZero()) continue;
      touches.push_back(touchOf(context.state, contact, c));
      if (context.bend != nullptr) touches.back().motion += contact.yield * loads.tool_yield.displacement;
    }
  }

 private:
  // Where the particles go if nothing stops them.
  void lookAhead(const StepContext& context) {
    const State& state = context.state;
    for (std::size_t i = 0; i < ahead_x_.size(); ++i) {
      ahead_x_[i] = state.x[i] + context.step * state.vx[i];
      ahead_y_[i] = state.y[i] + context.step * state.vy[i];
      ahead_z_[i] = state.z[i] + context.step * state.vz[i];
    }
  }

  void findContacts(const StepContext& context, BodyLoads& loads) {
    const Model& model = context.model;
    const double reach = model.particle_radius + kContactMargin;
    collision_.findCandidates(context.tool->end, ahead_x_.data(), ahead_y_.data(), ahead_z_.data(),
                              model.particle_count, reach);
    if (collision_.candidateCount() == 0) return;
    const auto& contacts =
        collision_.findContacts(context.tool->end, ahead_x_.data(), ahead_y_.data(), ahead_z_.data(), reach);
    const std::vector<GripPoint>& grip = context.state.grip;
    forEachDeepest(contacts, [&](const Contact& contact) {
      const int i = contact.particle;
      // the ends are open where the organ goes on: the scope passes through their closing surface
      const bool held = std::any_of(grip.begin(), grip.end(), [i](const GripPoint& p) { return p.particle == i; });
      if (model.organ.end[i] == End::None && !held && model.inverse_mass[i] > 0) addContact(context, contact, loads);
    });
  }

  void addContact(const StepContext& context, const Contact& contact, BodyLoads& loads) {
    const Model& model = context.model;
    const State& state = context.state;
    const int i = contact.particle;
    const int link = model.tool->shapes()[contact.shape].link;
    const Eigen::Vector3d p(state.x[i], state.y[i], state.z[i]), ahead(ahead_x_[i], ahead_y_[i], ahead_z_[i]);
    const Eigen::Vector3d anchor = context.tool->end[link] * (context.tool->start[link].inverse() * p);
    ContactConstraint& constraint = loads.contacts.add();
    constraint = ContactConstraint();
    constraint.point = SurfacePoint::ofNode(i);
    constraint.normal = contact.normal;
    const double surface = contact.normal.dot(ahead) - contact.distance + model.particle_radius;
    // a particle deep inside (the tool was put there) comes out slowly, not at once
    constraint.offset = std::min(surface, contact.normal.dot(anchor) + kDepenetrationSpeed * context.step);
    constraint.friction = model.scene.scope->friction;
    constraint.anchor = anchor;
    constraint.yield = toolYield(context, link, anchor);
    motion_.emplace_back(anchor - p);
    link_.push_back(link);
  }

  ToolTouch touchOf(const State& state, const ContactConstraint& contact, std::size_t number) const {
    const int i = contact.point.node[0];
    ToolTouch touch;
    touch.kind = ToolTouch::Kind::Contact;
    touch.node = i;
    touch.link = link_[number];
    touch.point = {state.x[i], state.y[i], state.z[i]};
    touch.motion = motion_[number];
    touch.force = contact.force;
    const double push = contact.force.dot(contact.normal);
    const double drag = (contact.force - push * contact.normal).norm();
    const Eigen::Vector3d tangent = contact.normal.unitOrthogonal();
    touch.direction = {contact.normal, tangent, contact.normal.cross(tangent)};
    touch.direction_count = drag < kSticks * contact.friction * push ? 3 : 1;
    return touch;
  }

  ToolCollision collision_;
  std::vector<double> ahead_x_, ahead_y_, ahead_z_;  // [m]
  std::size_t first_ = 0;                            // of its contacts in the loads
  std::vector<Eigen::Vector3d> motion_;              // of the tool at each contact [m]
  std::vector<int> link_;                            // of the tool at each contact
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeToolContactBlock(const Model& model) {
  return model.tool ? std::make_unique<ToolContactBlock>(model) : nullptr;
}

}  // namespace vibe
