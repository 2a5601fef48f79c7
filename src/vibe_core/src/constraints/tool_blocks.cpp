#include <algorithm>
#include <array>

#include "constraints/blocks.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/contact_memory.hpp"
#include "tool_contact/contact_places.hpp"
#include "tool_contact/shape_distance.hpp"
#include "tool_contact/surface_contacts.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

Eigen::Matrix<double, 3, kYieldDofs> toolYield(const StepContext& context, int link, const Eigen::Vector3d& point) {
  if (context.bend == nullptr) return Eigen::Matrix<double, 3, kYieldDofs>::Zero();
  const Eigen::Vector3d local = context.tool->end[link].inverse() * point;
  return yieldJacobian(*context.model.tool, context.tool->middle, *context.bend, link,
                       context.tool->middle[link] * local);
}

namespace {

class ToolContactBlock : public ConstraintBlock {
 public:
  explicit ToolContactBlock(const Model& model)
      : passable_(passableVertices(model.organ)),
        excluded_(passable_.size()),
        contacts_(*model.tool, model.organ.surface, model.organ.thickness, passable_),
        memory_(*model.tool),
        places_(model.organ) {
    for (const ToolShape& shape : model.tool->shapes()) distance_.emplace_back(*shape.shape);
    for (auto& v : ahead_) v.resize(static_cast<std::size_t>(model.particle_count));
  }

  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    first_ = loads.contacts.size();
    local_point_.clear();
    origin_.clear();
    if (context.tool == nullptr) return Activity::Sleep;
    lookAhead(context);
    exclude(context);
    findContacts(context, loads);
    return local_point_.empty() ? Activity::Sleep : Activity::Disturb;
  }

  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>& touches) override {
    keepContacts(context, loads);
    for (std::size_t c = 0; c < local_point_.size(); ++c) {
      const ContactConstraint& contact = loads.contacts[first_ + c];
      if (!contact.force.isZero()) touches.push_back(touchOf(context, contact, c));
    }
    return 0;
  }

 private:
  // Predicts where the wall goes if nothing stops it.
  void lookAhead(const StepContext& context) {
    const State& state = context.state;
    const std::array<const std::vector<double>*, 3> x{&state.x, &state.y, &state.z}, v{&state.vx, &state.vy, &state.vz};
    for (std::size_t k = 0; k < 3; ++k) {
      path_.from[k] = x[k]->data();
      path_.to[k] = ahead_[k].data();
      for (std::size_t i = 0; i < ahead_[k].size(); ++i) ahead_[k][i] = (*x[k])[i] + context.step * (*v[k])[i];
    }
  }

  // Marks what is held or fixed: it takes no part, because it cannot move.
  void exclude(const StepContext& context) {
    for (std::size_t i = 0; i < excluded_.size(); ++i)
      excluded_[i] = passable_[i] != 0 || context.model.inverse_mass[i] == 0 ? 1 : 0;
    const double whole = wholeWeight(context.state.grip);
    for (const GripPoint& point : context.state.grip)
      if (point.weight >= whole) excluded_[static_cast<std::size_t>(point.particle)] = kHeld;
  }

  void findContacts(const StepContext& context, BodyLoads& loads) {
    const ToolPoses& poses = *context.tool;
    const std::vector<SurfaceContact>& found = contacts_.find(poses.start, poses.end, path_, stepPolicy().touch_margin,
                                                              excluded_, context.when, poses.needle_leads);
    const std::vector<SurfaceContact>& counting =
        loads.held_still ? memory_.recall(found, poses, context.state, keptWay(context), excluded_) : found;
    for (const SurfaceContact& contact : counting) addContact(context, contact, loads);
  }

  static double keptWay(const StepContext& context) {
    const StepPolicy& policy = stepPolicy();
    const double held = context.state.hold.steps * context.step - policy.hold_time;
    return std::min((1 + policy.touch_kept_growth * held) * policy.touch_kept, policy.touch_kept_most);
  }

  void keepContacts(const StepContext& context, const BodyLoads& loads) const {
    HoldMemory& hold = context.state.hold;
    hold.contacts.clear();
    if (!loads.held_still) return;
    hold.contacts = memory_.kept();
    for (std::size_t c = 0; c < hold.contacts.size(); ++c) {
      const int link = context.model.tool->shapes()[hold.contacts[c].shape].link;
      hold.contacts[c].force = context.tool->end[link].linear().transpose() * loads.contacts[first_ + c].force;
    }
  }

  void addContact(const StepContext& context, const SurfaceContact& contact, BodyLoads& loads) {
    const Model& model = context.model;
    const int link = model.tool->shapes()[contact.shape].link;
    // The point of the tool that touches goes with its link: friction acts against its motion.
    const Eigen::Vector3d p = positionOf(contact.point, context.state);
    const Eigen::Vector3d local = context.tool->start[link].inverse() * p, anchor = context.tool->end[link] * local;
    ContactConstraint& constraint = loads.contacts.add();
    constraint = ContactConstraint();
    constraint.point = contact.point;
    constraint.force = contact.force;
    constraint.normal = contact.normal;
    const double surface = contact.normal.dot(contact.tool_point) + contact.clearance;
    // What is deep inside (the tool was put there) comes out slowly, not at once.
    constraint.offset = std::min(surface, contact.normal.dot(anchor) + stepPolicy().touch_push_out * context.step);
    constraint.compliance = complianceOf(model, contact);
    constraint.friction = model.scene.scope->friction;
    constraint.anchor = anchor;
    constraint.yield = toolYield(context, link, anchor);
    constraint.driven = drivenBy(context, link, anchor);
    local_point_.push_back(local);
    origin_.push_back({contact.shape, contact.clearance});
  }

  // By the drive of a needle arm that is a body.
  static Eigen::Vector3d drivenBy(const StepContext& context, int link, const Eigen::Vector3d& point) {
    const auto& arm = context.model.tool->needleLinkage();
    if (!arm || (link != arm->arm && link != arm->hook)) return Eigen::Vector3d::Zero();
    return pointJacobian(*context.model.tool, context.tool->end, link, point).col(NeedleDriver);
  }

  // Equation (10): the inner half of the wall, between tool and mid-surface, is compressed where it cannot yield
  // sideways.
  static double complianceOf(const Model& model, const SurfaceContact& contact) {
    double area = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.point.count); ++k)
      area += contact.point.weight[k] * model.area[contact.point.node[k]];
    return contact.clearance / (stepPolicy().touch_confined * model.scene.tissue.young_modulus * area);
  }

  ToolTouch touchOf(const StepContext& context, const ContactConstraint& contact, std::size_t number) const {
    ToolTouch touch;
    touch.kind = ToolTouch::Kind::Contact;
    touch.surface = contact.point;
    touch.compliance = contact.compliance;
    touch.shape = origin_[number].shape;
    touch.link = context.model.tool->shapes()[touch.shape].link;
    touch.point = positionOf(contact.point, context.state);
    touch.normal = contact.normal;
    touch.gap = distanceOf(context, touch) - origin_[number].clearance;
    places_.place(touch);
    const Eigen::Vector3d from = context.tool->start[touch.link] * local_point_[number];
    touch.motion = context.tool->end[touch.link] * local_point_[number] - from;
    touch.middle = from + 0.5 * touch.motion;
    touch.force = -contact.force;
    touch.work = contact.work;
    const double push = contact.force.dot(contact.normal);
    const double drag = (contact.force - push * contact.normal).norm();
    const Eigen::Vector3d tangent = contact.normal.unitOrthogonal();
    touch.direction = {contact.normal, tangent, contact.normal.cross(tangent)};
    touch.direction_count = drag < stepPolicy().touch_sticks * contact.used_friction * push ? 3 : 1;
    return touch;
  }

  // Of the point from the surface of its shape at the end of the step [m].
  double distanceOf(const StepContext& context, const ToolContact& contact) const {
    const ToolShape& shape = context.model.tool->shapes()[contact.shape];
    const Eigen::Isometry3d pose = context.tool->end[contact.link] * shape.origin;
    Eigen::Vector3d normal;
    return distance_[contact.shape](pose.inverse() * contact.point, normal);
  }

  // What a contact of the loads comes from.
  struct Origin {
    int shape;         // of the tool
    double clearance;  // of the mid-surface from the shape where it touches [m]
  };

  std::vector<char> passable_, excluded_;  // per node
  SurfaceContacts contacts_;
  ContactMemory memory_;
  ContactPlaces places_;
  std::vector<PointDistance> distance_;       // per shape
  std::array<std::vector<double>, 3> ahead_;  // [m]
  SurfacePath path_;
  std::size_t first_ = 0;                     // of its contacts in the loads
  std::vector<Eigen::Vector3d> local_point_;  // of each contact at the start of the step, in the frame of its link [m]
  std::vector<Origin> origin_;                // of each contact
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeToolContactBlock(const Model& model) {
  return model.tool ? std::make_unique<ToolContactBlock>(model) : nullptr;
}

}  // namespace vibe
