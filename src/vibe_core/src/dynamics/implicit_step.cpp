#include "dynamics/implicit_step.hpp"
#include "constraints/group_draw.hpp"
#include "vibe_core/constraints/pull_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constraints/gas.hpp"
#include "constraints/thread_loads.hpp"
#include "dynamics/tool_contact_rows.hpp"
#include "geometry/lumen.hpp"
#include "solver/stepper_scratch.hpp"

namespace vibe {

namespace {

constexpr double kContactMargin = 2e-3;  // particles this near may be reached within the step [m]
constexpr double kMinReach = 5e-4;       // of the search for walls that come near each other [m]
constexpr double kRestSpeed = 2e-6;      // slower than this is rest: a micrometre in half a second [m/s]
constexpr int kWakeEvery = 30;
constexpr int kRestSteps = 15;               // of it, before the tissue sleeps
constexpr double kRecoveryTime = 0.5;        // a state beyond hope takes to rest [s]
constexpr double kRecoveryRate = 20;         // of what is left of the way [1/s]
constexpr int kLookEvery = 10;               // steps between looks whether the organ is inside out
constexpr double kDepenetrationSpeed = 0.1;  // a particle found inside the tool is pushed out no faster [m/s]

bool drawsThread(const State& state) {
  const std::vector<Suture>& sutures = state.procedure.sutures;
  return !sutures.empty() && sutures.back().stage == Suture::Stage::Cinching;
}

}  // namespace

ImplicitStep::ImplicitStep(const Model& model, const ImplicitStepper& stepper, double absurd_energy,
                           const ToolMotion* motion, bool insufflator_on, State& state, ImplicitScratch& scratch,
                           StepReport& report)
    : model_(model),
      stepper_(stepper),
      absurd_energy_(absurd_energy),
      motion_(motion),
      insufflator_on_(insufflator_on),
      state_(state),
      report_(report),
      scratch_(scratch),
      h_(model.scene.step_period) {}

void ImplicitStep::run() {
  const std::size_t grips = motion_ != nullptr ? state_.grip.size() : 0;
  scratch_.loads.constraints.resize(3 * (grips + (state_.pull.holds() ? 1 : 0)));
  scratch_.loads.contacts.clear();
  scratch_.contact_motion.clear();
  scratch_.contact_link.clear();
  if (motion_ != nullptr) {
    placeTool();
    holdGrip();
    findContacts();
  }
  if (state_.pull.holds()) holdPatch();
  fillThreads(model_, state_, scratch_.loads);
  if (atRest()) return;
  fillGas();
  const double old_volume = state_.volume, old_pressure = state_.pressure;
  const Eigen::Vector3d old_place = heldPosition(state_);
  segmentLengths(scratch_.loads, state_, scratch_.old_segments);
  MotionView view{{state_.x.data(), state_.y.data(), state_.z.data()},
                  {state_.vx.data(), state_.vy.data(), state_.vz.data()},
                  {state_.ax.data(), state_.ay.data(), state_.az.data()}};
  if (state_.solver.recovery_steps == 0 && lost(view)) {
    report_.put_back = true;
    state_.solver.recovery_steps = std::max(1, static_cast<int>(std::lround(kRecoveryTime / h_)));
  }
  if (state_.solver.recovery_steps > 0) {
    recoverStep();
    account(old_volume, old_pressure);
    return;
  }
  scratch_.groups.prepare(model_, state_);
  detectSelfContact();  // not before: in a heap of particles that is led home all walls are near each other
  const StepOutcome outcome = stepper_.step(view, scratch_.loads, state_.solver, *scratch_.stepper);
  report_.iterations = outcome.iterations;
  report_.fallback = outcome.fallback;
  if (!outcome.finite) {
    std::fill(state_.x.begin(), state_.x.end(), std::numeric_limits<double>::quiet_NaN());  // the simulator recovers
    return;
  }
  stopAtSelfContact();
  reportForces();
  if (state_.pull.holds()) reportPull(old_place);
  reportThreads();
  reportResponse();
  account(old_volume, old_pressure);
  noticeRest();
}

// Elasticity has no way back from everywhere: a torn-about or everted wall rests in some other shape.
bool ImplicitStep::lost(const MotionView& motion) const {
  const StepperMemory& memory = state_.solver;
  const double energy = memory.steps == 0 ? stepper_.elasticEnergy(motion, *scratch_.stepper) : memory.elastic_energy;
  if (energy > absurd_energy_) return true;
  return memory.steps % kLookEvery == 0 && lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z) < 0;
}

// Straight, without forces: what is not physical needs no physics.
void ImplicitStep::recoverStep() {
  StepperMemory fresh;
  fresh.steps = state_.solver.steps + 1;
  fresh.recovery_steps = state_.solver.recovery_steps - 1;
  state_.solver = fresh;
  const double part = 1 - std::exp(-kRecoveryRate * h_);
  for (int i = 0; i < model_.particle_count; ++i) {
    const Eigen::Vector3d& rest = model_.organ.surface.vertices[i];
    state_.x[i] += part * (rest.x() - state_.x[i]);
    state_.y[i] += part * (rest.y() - state_.y[i]);
    state_.z[i] += part * (rest.z() - state_.z[i]);
  }
  for (auto* v : {&state_.vx, &state_.vy, &state_.vz, &state_.ax, &state_.ay, &state_.az})
    std::fill(v->begin(), v->end(), 0.0);
  for (Suture& suture : state_.procedure.sutures) slackenGroup(state_, suture.group);
  state_.pull.target = heldPosition(state_);
  state_.pull.force.setZero();
}

// The whole organ has come to rest and nothing acts on it that did not before. Now and then it looks whether that still
// holds: the state may have come from another scene.
bool ImplicitStep::atRest() const {
  return state_.solver.rest_steps >= kRestSteps && state_.step % kWakeEvery != 0 &&
         scratch_.loads.constraints.empty() && scratch_.loads.contacts.empty() &&
         !(insufflator_on_ && model_.scene.gas) && !drawsThread(state_);
}

void ImplicitStep::noticeRest() {
  double fastest2 = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    fastest2 =
        std::max(fastest2, state_.vx[i] * state_.vx[i] + state_.vy[i] * state_.vy[i] + state_.vz[i] * state_.vz[i]);
  const bool still = fastest2 < kRestSpeed * kRestSpeed && scratch_.loads.constraints.empty() &&
                     scratch_.loads.contacts.empty() && !(insufflator_on_ && model_.scene.gas);
  state_.solver.rest_steps = still ? state_.solver.rest_steps + 1 : 0;
  if (state_.solver.rest_steps < kRestSteps) return;
  for (auto* v : {&state_.vx, &state_.vy, &state_.vz, &state_.ax, &state_.ay, &state_.az})
    std::fill(v->begin(), v->end(), 0.0);
}

void ImplicitStep::placeTool() {
  motion_->linkPoses(0, scratch_.old_poses);
  motion_->linkPoses(1, scratch_.poses);
  for (int i = 0; i < model_.particle_count; ++i) {
    scratch_.ahead_x[i] = state_.x[i] + h_ * state_.vx[i];
    scratch_.ahead_y[i] = state_.y[i] + h_ * state_.vy[i];
    scratch_.ahead_z[i] = state_.z[i] + h_ * state_.vz[i];
  }
}

// Three conditions per held particle: where the helix takes it.
void ImplicitStep::holdGrip() {
  for (std::size_t g = 0; g < state_.grip.size(); ++g) {
    const GripPoint& point = state_.grip[g];
    const Eigen::Vector3d target = scratch_.poses[model_.grip_link] * point.local;
    for (int k = 0; k < 3; ++k) {
      LinearConstraint& constraint = scratch_.loads.constraints[3 * g + static_cast<std::size_t>(k)];
      constraint.node.assign(1, point.particle);
      constraint.coefficient.assign(1, Eigen::Vector3d::Unit(k));
      constraint.target = target[k];
      constraint.compliance = 0;
    }
  }
}

// The last three conditions: a spring from the mean of the patch to the hand.
void ImplicitStep::holdPatch() {
  const PullSpring& pull = state_.pull;
  const std::size_t first = scratch_.loads.constraints.size() - 3;
  for (int k = 0; k < 3; ++k) {
    LinearConstraint& constraint = scratch_.loads.constraints[first + static_cast<std::size_t>(k)];
    constraint.node = pull.node;
    constraint.coefficient.clear();
    for (double weight : pull.weight) constraint.coefficient.emplace_back(weight * Eigen::Vector3d::Unit(k));
    constraint.target = pull.target[k];
    constraint.compliance = 1 / kPullStiffness;
  }
}

void ImplicitStep::findContacts() {
  const double reach = model_.particle_radius + kContactMargin;
  scratch_.collision->findCandidates(scratch_.poses, scratch_.ahead_x.data(), scratch_.ahead_y.data(),
                                     scratch_.ahead_z.data(), model_.particle_count, reach);
  if (scratch_.collision->candidateCount() == 0) return;
  const auto& contacts = scratch_.collision->findContacts(scratch_.poses, scratch_.ahead_x.data(),
                                                          scratch_.ahead_y.data(), scratch_.ahead_z.data(), reach);
  for (std::size_t first = 0, next; first < contacts.size(); first = next) {
    // contacts come by particle; where shapes overlap, the deepest leads out of both
    std::size_t deepest = first;
    for (next = first + 1; next < contacts.size() && contacts[next].particle == contacts[first].particle; ++next)
      if (contacts[next].distance < contacts[deepest].distance) deepest = next;
    const int i = contacts[deepest].particle;
    // the ends are open where the organ goes on: the scope passes through their closing surface
    const bool held =
        std::any_of(state_.grip.begin(), state_.grip.end(), [i](const GripPoint& p) { return p.particle == i; });
    if (model_.organ.end[i] == End::None && !held && model_.inverse_mass[i] > 0) addContact(contacts[deepest]);
  }
}

// Walls of the organ that can meet within the step: nodes and their partners both move.
void ImplicitStep::detectSelfContact() {
  scratch_.terms.set(scratch_.walls.get(), scratch_.groups.count() > 0 ? &scratch_.groups : nullptr);
  scratch_.loads.extra = scratch_.terms.simplest();
  if (!scratch_.walls) return;
  double fastest2 = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    fastest2 =
        std::max(fastest2, state_.vx[i] * state_.vx[i] + state_.vy[i] * state_.vy[i] + state_.vz[i] * state_.vz[i]);
  const double reach = std::clamp(2.5 * h_ * std::sqrt(fastest2), kMinReach, model_.particle_radius);
  scratch_.walls->detect(state_.x.data(), state_.y.data(), state_.z.data(), reach);
}

// A step may end with walls that have passed through each other: iterations end early, tools jump. They stop instead.
void ImplicitStep::stopAtSelfContact() {
  if (!scratch_.walls) return;
  scratch_.walls->resolvePenetrations({{state_.x.data(), state_.y.data(), state_.z.data()},
                                       {state_.vx.data(), state_.vy.data(), state_.vz.data()},
                                       {state_.ax.data(), state_.ay.data(), state_.az.data()}},
                                      h_);
}

void ImplicitStep::addContact(const Contact& contact) {
  const int i = contact.particle;
  const int link = model_.tool->shapes()[contact.shape].link;
  const Eigen::Vector3d p = position(i);
  const Eigen::Vector3d ahead(scratch_.ahead_x[i], scratch_.ahead_y[i], scratch_.ahead_z[i]);
  const Eigen::Vector3d anchor = scratch_.poses[link] * (scratch_.old_poses[link].inverse() * p);
  ContactConstraint constraint;
  constraint.node = i;
  constraint.normal = contact.normal;
  const double surface = contact.normal.dot(ahead) - contact.distance + model_.particle_radius;
  // a particle deep inside (the tool was put there) comes out slowly, not at once
  constraint.offset = std::min(surface, contact.normal.dot(anchor) + kDepenetrationSpeed * h_);
  constraint.friction = model_.scene.scope->friction;
  constraint.anchor = anchor;
  scratch_.loads.contacts.push_back(constraint);
  scratch_.contact_motion.emplace_back(anchor - p);
  scratch_.contact_link.push_back(link);
}

void ImplicitStep::fillGas() {
  GasLoad& gas = scratch_.loads.gas;
  gas.control = model_.scene.gas ? GasLoad::Control::Amount : GasLoad::Control::None;
  if (!model_.scene.gas) return;
  if (insufflator_on_) state_.gas_amount = insufflate(*model_.scene.gas, state_.gas_amount, state_.volume, h_);
  gas.amount = state_.gas_amount;
  gas.ambient = kAmbientPressure;
  gas.volume = state_.volume;
}

void ImplicitStep::reportForces() {
  for (std::size_t g = 0; g < state_.grip.size(); ++g) {
    const GripPoint& point = state_.grip[g];
    Eigen::Vector3d force;  // tool on tissue
    for (int k = 0; k < 3; ++k) force[k] = scratch_.loads.constraints[3 * g + static_cast<std::size_t>(k)].force;
    const Eigen::Vector3d target = scratch_.poses[model_.grip_link] * point.local;
    report_.grip_force -= force;
    pushTool(-force, target, target - scratch_.old_poses[model_.grip_link] * point.local);
  }
  for (std::size_t c = 0; c < scratch_.loads.contacts.size(); ++c) {
    const ContactConstraint& contact = scratch_.loads.contacts[c];
    if (contact.force.isZero()) continue;
    ++report_.contact_count;
    pushTool(-contact.force, position(contact.node), scratch_.contact_motion[c]);
  }
}

void ImplicitStep::reportPull(const Eigen::Vector3d& old_place) {
  const std::size_t first = scratch_.loads.constraints.size() - 3;
  for (int k = 0; k < 3; ++k)
    state_.pull.force[k] = scratch_.loads.constraints[first + static_cast<std::size_t>(k)].force;
  state_.energy.pull_work += state_.pull.force.dot(heldPosition(state_) - old_place);
}

void ImplicitStep::reportThreads() {
  segmentLengths(scratch_.loads, state_, scratch_.segments);
  state_.energy.thread_work += threadWork(scratch_.loads, state_, scratch_.old_segments, scratch_.segments);
  storeThreads(scratch_.loads, state_);
  scratch_.groups.report(state_);
}

// Begins before anything is touched: what the response needs takes a while to make.
void ImplicitStep::reportResponse() {
  if (motion_ == nullptr || (state_.grip.empty() && scratch_.loads.contacts.empty())) return;
  findToolContactRows(model_, *motion_, stepper_, report_, state_, scratch_);
  const StepperScratch& stepper = *scratch_.stepper;
  const double gas_stiffness = model_.scene.gas ? state_.gas_amount / (stepper.volume * stepper.volume) : 0;
  report_.tool_impedance =
      scratch_.response->update(state_.step, scratch_.touch, {state_.x.data(), state_.y.data(), state_.z.data()},
                                stepper.volume_gradient, gas_stiffness, state_.impedance);
}

// force: tissue on tool [N] at a point in world; tool_step: how far the tool moved there in this step [m]
void ImplicitStep::pushTool(const Eigen::Vector3d& force, const Eigen::Vector3d& at, const Eigen::Vector3d& tool_step) {
  report_.tool_force += force;
  report_.tool_torque += (at - scratch_.poses[model_.tip_link].translation()).cross(force);
  state_.energy.tool_work -= force.dot(tool_step);
}

void ImplicitStep::account(double old_volume, double old_pressure) {
  double kinetic = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    if (model_.inverse_mass[i] > 0)
      kinetic += 0.5 * model_.mass[i] *
                 (state_.vx[i] * state_.vx[i] + state_.vy[i] * state_.vy[i] + state_.vz[i] * state_.vz[i]);
  state_.energy.damping_loss += 2 * kinetic * model_.scene.tissue.mass_damping * h_;
  if (!model_.scene.gas) return;
  state_.volume = lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z);
  state_.pressure = gaugePressure(state_.gas_amount, state_.volume);
  state_.energy.gas_work += 0.5 * (old_pressure + state_.pressure) * (state_.volume - old_volume);
}

}  // namespace vibe
