#include "suture/hanging_thread.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "suture/chain_lengths.hpp"
#include "suture/chain_newton.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/suture/catenary.hpp"

namespace vibe {

namespace {

void check(bool right, const char* what, const char* remedy) {
  if (!right) throw Error(std::string("A hanging thread was given ") + what + ": " + remedy + ".");
}

bool isPositive(double value) {
  return std::isfinite(value) && value > 0;
}

void checkModel(const HangingThreadModel& model, const ThreadEnds& ends) {
  check(model.links >= 1, "no links", "give 1 or more");
  check(isPositive(model.length) && isPositive(model.mass_per_length) && isPositive(model.axial_stiffness),
        "a length, mass or stiffness that is not above 0", "take them from its material");
  check(std::isfinite(model.tip_mass) && model.tip_mass >= 0 && std::isfinite(model.drag) && model.drag >= 0,
        "a tip mass or drag that is not a number from 0 on", "give kilograms and 1/s");
  check(isPositive(model.largest_substep), "a largest sub-step that is not above 0", "give seconds");
  check(model.gravity.allFinite(), "a gravity that is not finite", "give three finite numbers");
  check(ends.first.allFinite() && ends.last.allFinite(), "an end that is not a finite position",
        "check what holds the thread");
}

void checkState(const HangingThreadModel& model, double dt, const HangingThread& state) {
  const int nodes = model.links + 1;
  check(isPositive(dt), "a step that is not above 0", "give seconds");
  check(state.position.cols() == nodes && state.velocity.cols() == nodes && state.tension.size() == model.links,
        "a state of another number of links", "start from threadAtRest()");
  check(state.position.allFinite() && state.velocity.allFinite() && state.tension.allFinite(),
        "a state that is not finite", "start anew from threadAtRest()");
}

/// Target of each node: its position under gravity and inertia alone.
void aim(const HangingThreadModel& model, double h, const HangingThread& state, HangingThreadScratch& scratch) {
  const double fade = 1 / (1 + h * model.drag);
  for (int j = 0; j <= model.links; ++j)
    scratch.target.col(j) = state.position.col(j) + h * fade * (state.velocity.col(j) + h * model.gravity);
}

/// Initial guess: the targets, with held ends at their positions and the nodes in between shifted linearly. Otherwise
/// an end that moves by many links would stretch one link to many times its length, and Newton's method would converge
/// slowly or not at all.
void guess(const HangingThreadModel& model, const ThreadEnds& ends, HangingThread& state,
           const HangingThreadScratch& scratch) {
  const int last = model.links;
  Eigen::Vector3d first_way = ends.first - scratch.target.col(0), last_way = ends.last - scratch.target.col(last);
  if (!ends.first_held) first_way = ends.last_held ? last_way : Eigen::Vector3d::Zero();
  if (!ends.last_held) last_way = first_way;
  for (int j = 0; j <= last; ++j) {
    const double share = static_cast<double>(j) / last;
    state.position.col(j) = scratch.target.col(j) + (1 - share) * first_way + share * last_way;
  }
  if (ends.first_held) state.position.col(0) = ends.first;
  if (ends.last_held) state.position.col(last) = ends.last;
}

void substep(const HangingThreadModel& model, const ThreadEnds& ends, double h, HangingThread& state,
             HangingThreadScratch& scratch) {
  aim(model, h, state, scratch);
  scratch.start = state;
  guess(model, ends, state, scratch);
  if (!detail::settleChain(model, ends, h, state, scratch)) {
    if (!state.position.allFinite()) state.position = scratch.start.position;
    detail::restoreLengths(model, ends, state.position);
    state.tension = scratch.start.tension;
  }
  state.velocity = (state.position - scratch.start.position) / h;
}

}  // namespace

double HangingThreadModel::nodeMass(int node) const {
  const double link = mass_per_length * linkLength();
  if (node == 0) return 0.5 * link;
  return node == links ? 0.5 * link + tip_mass : link;
}

HangingThreadModel hangingThread(const ThreadMaterial& material, double length, int links,
                                 const Eigen::Vector3d& gravity) {
  HangingThreadModel model;
  model.links = links;
  model.length = length;
  model.mass_per_length = material.massPerLength();
  model.axial_stiffness = material.axialStiffness();
  model.tip_mass = 0;
  model.drag = 0.9;
  model.largest_substep = 1.0 / 480;
  model.gravity = gravity;
  return model;
}

HangingThread threadAtRest(const HangingThreadModel& model, const ThreadEnds& ends) {
  checkModel(model, ends);
  const double gravity = model.gravity.norm();
  const Eigen::Vector3d down = gravity > 0 ? Eigen::Vector3d(model.gravity / gravity) : -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d first = ends.first, last = ends.last;
  if (!ends.last_held) last = first + down * model.length;
  if (ends.last_held && !ends.first_held) first = last + down * model.length;
  const Catenary shape = hang(first, last, model.length, model.mass_per_length * gravity, down);
  const bool hangs_free = !(ends.first_held && ends.last_held);
  HangingThread state;
  state.position.resize(3, model.links + 1);
  state.velocity.setZero(3, model.links + 1);
  state.tension.setZero(model.links);
  for (int j = 0; j <= model.links; ++j) state.position.col(j) = shape.point(model.length * j / model.links);
  for (int k = 0; k < model.links; ++k) {
    const double middle = model.linkLength() * (k + 0.5);
    state.tension[k] = shape.tension(middle);
    if (!hangs_free) continue;
    const double below = ends.last_held && !ends.first_held ? middle : model.length - middle;
    const bool carries_tip = ends.first_held && !ends.last_held;
    state.tension[k] = (below * model.mass_per_length + (carries_tip ? model.tip_mass : 0)) * gravity;
  }
  return state;
}

void stepThread(const HangingThreadModel& model, const ThreadEnds& ends, double dt, HangingThread& state,
                HangingThreadScratch& scratch) {
  checkModel(model, ends);
  checkState(model, dt, state);
  detail::fitScratch(model.links, scratch);
  const double wanted = std::ceil(dt / model.largest_substep * (1 - 1e-9));
  check(wanted <= 1e6, "a step of more than a million sub-steps", "give a shorter step");
  const int count = std::max(1, static_cast<int>(wanted));
  const Eigen::Vector3d first = state.position.col(0), last = state.position.col(model.links);
  ThreadEnds moving = ends;
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    moving.first = i == count ? ends.first : Eigen::Vector3d(first + share * (ends.first - first));
    moving.last = i == count ? ends.last : Eigen::Vector3d(last + share * (ends.last - last));
    substep(model, moving, dt / count, state, scratch);
  }
}

Eigen::Vector3d pullOnFirst(const HangingThreadModel& model, const HangingThread& state) {
  const Eigen::Vector3d along = state.position.col(1) - state.position.col(0);
  return state.tension[0] * along.stableNormalized() + model.nodeMass(0) * model.gravity;
}

Eigen::Vector3d pullOnLast(const HangingThreadModel& model, const HangingThread& state) {
  const Eigen::Vector3d along = state.position.col(model.links - 1) - state.position.col(model.links);
  return state.tension[model.links - 1] * along.stableNormalized() + model.nodeMass(model.links) * model.gravity;
}

double chainLength(const HangingThread& state) {
  double sum = 0;
  for (int k = 0; k + 1 < state.position.cols(); ++k) sum += (state.position.col(k + 1) - state.position.col(k)).norm();
  return sum;
}

}  // namespace vibe
