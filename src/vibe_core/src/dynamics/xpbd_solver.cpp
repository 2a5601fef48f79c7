#include "dynamics/xpbd_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arithmetic/elementary.hpp"
#include "constraints/supports.hpp"
#include "model/step_accounts.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/tool_collision.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/constraints/gas.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

namespace {

// Cluster groups per piece of parallel work. Design choice: a piece takes some ten microseconds, long beside the cost
// of handing it to a thread. Fixed, so that sums do not depend on the number of threads.
constexpr int kGrain = 64;
// Sub-steps between searches for contact candidates. Design choice: a search costs about as much as ten evaluations of
// its candidates.
constexpr int kCandidateInterval = 10;
// Largest distance that tissue may travel between two searches. Design choice: faster tissue is about to be slowed by
// kMaxSpeed, and a longer reach would make every particle a candidate [m].
constexpr double kMaxTravel = 0.01;
// Added to the reach of a search. Design choice: covers accelerations between two searches [m].
constexpr double kCandidateMargin = 1e-3;
// Above this a particle is slowed down, and an event reports it. Design choice: far above the speed of any elastic wave
// in soft tissue (shear waves: 1 to 10 m/s), so that only an unstable step gets there [m/s].
constexpr double kMaxSpeed = 50;

}  // namespace

XpbdSubstep::XpbdSubstep(const Model& model, const ClusterSet& clusters, const ToolMotion* motion, bool insufflator_on,
                         State& state, XpbdWorkspace& scratch, ThreadPool& pool, StepReport& report)
    : model_(model),
      clusters_(clusters),
      motion_(motion),
      insufflator_on_(insufflator_on),
      state_(state),
      pool_(pool),
      report_(report),
      scratch_(scratch),
      h_(model.scene.step_period / model.substeps),
      inverse_h_(1 / h_),
      stiffness_damping_(model.scene.tissue.stiffness_damping),
      weight_(model.unbalanced_gravity) {
  if (motion_ != nullptr) scratch_.tool.end = scratch_.tool.start;
  loadOrientations(clusters, state, scratch_.buffers);
  scratch_.sweep = bindSweep(clusters, state, scratch_.buffers);
  scratch_.sweep.substep = h_;
  scratch_.sweep.x = scratch_.ahead_x.data();
  scratch_.sweep.y = scratch_.ahead_y.data();
  scratch_.sweep.z = scratch_.ahead_z.data();
  for (const auto& block : scratch_.added) block->substepLoad()->prepareSubsteps(model, state);
  scratch_.pull.prepare(model, state);
  for (auto& numbers : scratch_.contact_of) std::fill(numbers.begin(), numbers.end(), -1);
}

void XpbdSubstep::run(int index, int count) {
  moveTool(index, count);
  matchShapes();
  if (model_.scene.gas) updateGas();
  move();
  for (const auto& block : scratch_.added) block->substepLoad()->apply(model_, h_, state_);
  scratch_.pull.apply(model_, h_, state_);
  holdGrip();
  resolveContacts();
  limitSpeeds();
}

void XpbdSubstep::moveTool(int index, int count) {
  if (motion_ == nullptr) return;
  if (index % kCandidateInterval == 0) findCandidates(index, count);
  std::swap(scratch_.old_tool, scratch_.tool.end);
  motion_->linkPoses(static_cast<double>(index + 1) / count, scratch_.tool.end);
}

// Candidates for the next kCandidateInterval sub-steps: everything that tool and tissue can bring together by then.
void XpbdSubstep::findCandidates(int index, int count) {
  const int last = std::min(index + kCandidateInterval, count);
  motion_->linkPoses(static_cast<double>(last) / count, scratch_.tool_ahead);
  const double tissue_travel = std::min(2 * std::sqrt(maxSpeedSquared(state_)) * h_ * kCandidateInterval, kMaxTravel);
  const double reach = model_.particle_radius + motion_->travel(scratch_.tool.end, scratch_.tool_ahead) +
                       tissue_travel + kCandidateMargin;
  scratch_.collision->findCandidates(scratch_.tool.end, state_.x.data(), state_.y.data(), state_.z.data(),
                                     model_.particle_count, reach);
}

void XpbdSubstep::matchShapes() {
  lookAhead();
  pool_.parallelFor(clusters_.group_count, kGrain,
                    [&](int first, int last) { scratch_.sweep_function(scratch_.sweep, first, last); });
}

// The volume is homogeneous of degree 3 in the positions, so it is a third of position times derivative.
void XpbdSubstep::updateGas() {
  double volume = 0;
  for (int i = 0; i < model_.particle_count; ++i) {
    const int lane = clusters_.lane_of_particle[i];
    volume += scratch_.buffers.area_x[lane] * scratch_.ahead_x[i] +
              scratch_.buffers.area_y[lane] * scratch_.ahead_y[i] + scratch_.buffers.area_z[lane] * scratch_.ahead_z[i];
  }
  volume /= 3;
  if (insufflator_on_) state_.gas_amount = insufflate(*model_.scene.gas, state_.gas_amount, volume, h_);
  const double pressure = gaugePressure(state_.gas_amount, volume);
  state_.energy.gas_work += 0.5 * (state_.pressure + pressure) * (volume - state_.volume);
  state_.volume = volume;
  state_.pressure = pressure;
}

void XpbdSubstep::move() {
  const double decay = math::exp(-model_.scene.tissue.mass_damping * h_);
  accountDamping(decay);
  pool_.parallelFor(model_.particle_count, kGrain * ClusterSet::kLanes, [&](int first, int last) {
    for (int i = first; i < last; ++i) moveParticle(i, decay);
  });
}

void XpbdSubstep::moveParticle(int i, double decay) {
  scratch_.old_x[i] = state_.x[i];
  scratch_.old_y[i] = state_.y[i];
  scratch_.old_z[i] = state_.z[i];
  const double inverse_mass = model_.inverse_mass[i];
  if (inverse_mass == 0) return;
  const SweepBuffers& b = scratch_.buffers;
  double dx = 0, dy = 0, dz = 0;
  for (int k = clusters_.slot_offset[i]; k < clusters_.slot_offset[i + 1]; ++k) {
    const int slot = clusters_.slot[k];
    dx += b.dx[slot];
    dy += b.dy[slot];
    dz += b.dz[slot];
  }
  const int lane = clusters_.lane_of_particle[i];
  const double spring = scratch_.foundation_rate[i];
  const double push = state_.pressure * inverse_mass;
  const Eigen::Vector3d& rest = model_.organ.surface.vertices[i];
  const double ax = weight_.x() + spring * (rest.x() - state_.x[i]) + push * b.area_x[lane];
  const double ay = weight_.y() + spring * (rest.y() - state_.y[i]) + push * b.area_y[lane];
  const double az = weight_.z() + spring * (rest.z() - state_.z[i]) + push * b.area_z[lane];
  state_.vx[i] = state_.vx[i] * decay + (dx * inverse_h_ + h_ * ax);
  state_.vy[i] = state_.vy[i] * decay + (dy * inverse_h_ + h_ * ay);
  state_.vz[i] = state_.vz[i] * decay + (dz * inverse_h_ + h_ * az);
  state_.x[i] += h_ * state_.vx[i];
  state_.y[i] += h_ * state_.vy[i];
  state_.z[i] += h_ * state_.vz[i];
}

void XpbdSubstep::holdGrip() {
  if (state_.grip.empty()) return;
  const Eigen::Isometry3d& helix = scratch_.tool.end[model_.grip_link];
  const Eigen::Isometry3d& old_helix = scratch_.old_tool[model_.grip_link];
  const double whole = wholeWeight(state_.grip);
  for (const GripPoint& point : state_.grip) {
    if (point.weight < whole) continue;
    const int i = point.particle;
    const Eigen::Vector3d target = helix * point.local;
    const Eigen::Vector3d shift = target - Eigen::Vector3d(state_.x[i], state_.y[i], state_.z[i]);
    shiftParticle(i, shift);
    const Eigen::Vector3d force = -model_.mass[i] / (h_ * h_) * shift;
    report_.grip_force += force;
    pushTool(force, target, target - old_helix * point.local, tip(), report_, state_.energy);
    contactOf(i, ToolContact::Kind::Grip, model_.grip_link).force += force;
  }
}

void XpbdSubstep::resolveContacts() {
  if (motion_ == nullptr || scratch_.collision->candidateCount() == 0) return;
  const auto& contacts = scratch_.collision->findContacts(scratch_.tool.end, state_.x.data(), state_.y.data(),
                                                          state_.z.data(), model_.particle_radius);
  int touched = 0;
  forEachDeepest(contacts, [&](const Contact& contact) {
    // the ends are open where the organ goes on: the scope passes through their closing surface
    if (model_.organ.end[contact.particle] != End::None) return;
    pushOut(contact);
    ++touched;
  });
  report_.contact_count = std::max(report_.contact_count, touched);
}

// Non-penetration and Coulomb friction by displacement: what the particle came closer in this sub-step is undone at
// once, what it was inside before at a limited speed.
void XpbdSubstep::pushOut(const Contact& contact) {
  const int i = contact.particle;
  const int link = model_.tool->shapes()[contact.shape].link;
  const Eigen::Vector3d p(state_.x[i], state_.y[i], state_.z[i]);
  const Eigen::Vector3d old_p(scratch_.old_x[i], scratch_.old_y[i], scratch_.old_z[i]);
  const Eigen::Vector3d tool_step = p - scratch_.old_tool[link] * (scratch_.tool.end[link].inverse() * p);
  const Eigen::Vector3d slide = p - old_p - tool_step;
  const double normal_slide = contact.normal.dot(slide);
  const double depth = std::min(model_.particle_radius - contact.distance,
                                std::max(-normal_slide, 0.0) + stepPolicy().touch_push_out * h_);
  Eigen::Vector3d shift = depth * contact.normal;
  const Eigen::Vector3d tangential = slide - normal_slide * contact.normal;
  const double sliding = tangential.norm();
  if (sliding > 0) shift -= std::min(1.0, model_.scene.scope->friction * depth / sliding) * tangential;
  shiftParticle(i, shift);
  const Eigen::Vector3d force = -model_.mass[i] / (h_ * h_) * shift;
  pushTool(force, p, tool_step, tip(), report_, state_.energy);
  ToolContact& reported = contactOf(i, ToolContact::Kind::Contact, link);
  reported.force += force;
  reported.shape = contact.shape;
  reported.normal = contact.normal;
  reported.gap = contact.distance - model_.particle_radius;
}

// The force of a particle in this step, over all sub-steps.
ToolContact& XpbdSubstep::contactOf(int particle, ToolContact::Kind kind, int link) {
  int& number = scratch_.contact_of[static_cast<std::size_t>(kind)][static_cast<std::size_t>(particle)];
  if (number < 0) {
    number = static_cast<int>(report_.contacts.size());
    report_.contacts.emplace_back();
    report_.contacts.back().surface = SurfacePoint::ofNode(particle);
    scratch_.places->place(report_.contacts.back());
  }
  ToolContact& contact = report_.contacts[static_cast<std::size_t>(number)];
  contact.kind = kind;
  contact.link = link;
  return contact;
}

// A displacement imposed on a particle is an impulse.
void XpbdSubstep::shiftParticle(int i, const Eigen::Vector3d& shift) {
  state_.x[i] += shift.x();
  state_.y[i] += shift.y();
  state_.z[i] += shift.z();
  state_.vx[i] += shift.x() / h_;
  state_.vy[i] += shift.y() / h_;
  state_.vz[i] += shift.z() / h_;
}

void XpbdSubstep::limitSpeeds() {
  const double *vx = state_.vx.data(), *vy = state_.vy.data(), *vz = state_.vz.data();
  for (int i = 0; i < model_.particle_count; ++i) {
    const double speed2 = vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i];
    if (!(speed2 <= kMaxSpeed * kMaxSpeed)) limitSpeed(i, speed2);
  }
}

// Also undoes a velocity that is no number.
void XpbdSubstep::limitSpeed(int i, double speed2) {
  const double scale = std::isfinite(speed2) ? kMaxSpeed / std::sqrt(speed2) : 0;
  for (double* v : {&state_.vx[i], &state_.vy[i], &state_.vz[i]}) *v = scale == 0 ? 0 : *v * scale;
  state_.x[i] = scratch_.old_x[i] + h_ * state_.vx[i];
  state_.y[i] = scratch_.old_y[i] + h_ * state_.vy[i];
  state_.z[i] = scratch_.old_z[i] + h_ * state_.vz[i];
  ++report_.speed_limited;
}

// A force K (x + tau v) is the elastic force and a viscous one with the time constant tau.
void XpbdSubstep::lookAhead() {
  const double tau = stiffness_damping_;
  const std::size_t n = state_.x.size();
  const auto ahead = [tau, n](const std::vector<double>& x, const std::vector<double>& v, std::vector<double>& out) {
    const double *from = x.data(), *speed = v.data();
    double* to = out.data();
    for (std::size_t i = 0; i < n; ++i) to[i] = from[i] + tau * speed[i];
  };
  ahead(state_.x, state_.vx, scratch_.ahead_x);
  ahead(state_.y, state_.vy, scratch_.ahead_y);
  ahead(state_.z, state_.vz, scratch_.ahead_z);
}

void XpbdSubstep::accountDamping(double decay) {
  double kinetic = 0;
  for (int i = 0; i < model_.particle_count; ++i) {
    if (model_.inverse_mass[i] == 0) continue;
    kinetic +=
        model_.mass[i] * (state_.vx[i] * state_.vx[i] + state_.vy[i] * state_.vy[i] + state_.vz[i] * state_.vz[i]);
  }
  state_.energy.damping_loss += 0.5 * kinetic * (1 - decay * decay);
}

void XpbdSubstep::finish(int count) {
  storeOrientations(clusters_, scratch_.buffers, state_);
  for (const auto& block : scratch_.added) block->substepLoad()->reportSubsteps(count, state_);
  scratch_.pull.report(count, state_);
  report_.tool_force /= count;
  report_.tool_torque /= count;
  report_.grip_force /= count;
  for (ToolContact& contact : report_.contacts) {
    const int i = contact.surface.node[0];
    contact.force /= count;
    contact.point = {state_.x[i], state_.y[i], state_.z[i]};
  }
}

std::unique_ptr<SolverWorkspace> XpbdSolver::makeWorkspace(const Model& model) const {
  auto scratch = std::make_unique<XpbdWorkspace>();
  scratch->added = makeSubstepBlocks(model);
  const std::size_t n = static_cast<std::size_t>(model.particle_count);
  for (auto* v :
       {&scratch->old_x, &scratch->old_y, &scratch->old_z, &scratch->ahead_x, &scratch->ahead_y, &scratch->ahead_z})
    v->resize(n);
  const std::vector<double> foundation = foundationSprings(model.scene, model.area);
  scratch->foundation_rate.assign(n, 0);
  for (std::size_t i = 0; i < foundation.size(); ++i)
    scratch->foundation_rate[i] = foundation[i] * model.inverse_mass[i];
  scratch->buffers = makeSweepBuffers(tissue_->clusters());
  scratch->sweep_function = chooseClusterSweep();
  if (model.tool) {
    scratch->collision = std::make_unique<ToolCollision>(*model.tool);
    scratch->places = std::make_unique<ContactPlaces>(model.organ);
    for (auto& numbers : scratch->contact_of) numbers.resize(n);
  }
  return scratch;
}

void XpbdSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                         SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const {
  XpbdSubstep substep(model, tissue_->clusters(), motion, insufflator_on, state, static_cast<XpbdWorkspace&>(scratch),
                      pool, report);
  const int count = model.substeps;
  for (int i = 0; i < count; ++i) substep.run(i, count);
  substep.finish(count);
}

}  // namespace vibe
