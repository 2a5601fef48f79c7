#include "constraints/xpbd_pull.hpp"
#include "vibe_core/constraints/pull_patch.hpp"

#include <algorithm>

namespace vibe {

namespace {

constexpr double kShortest = 1e-6;  // segment that has a direction [m]

// A displacement imposed on a particle is an impulse.
void shift(int i, const Eigen::Vector3d& by, double substep, State& state) {
  state.x[i] += by.x(), state.y[i] += by.y(), state.z[i] += by.z();
  state.vx[i] += by.x() / substep, state.vy[i] += by.y() / substep, state.vz[i] += by.z() / substep;
}

/// @return length of the way from bite to bite [m]
double measure(const Suture& suture, const State& state, XpbdThread& thread) {
  const std::size_t count = suture.bites.size();
  thread.place.resize(count);
  thread.direction.assign(count, Eigen::Vector3d::Zero());
  for (std::size_t b = 0; b < count; ++b) thread.place[b] = bitePosition(suture.bites[b], state.x, state.y, state.z);
  double sum = 0;
  for (std::size_t b = 0; b + 1 < count; ++b) {
    const Eigen::Vector3d along = thread.place[b + 1] - thread.place[b];
    const double length = along.norm();
    sum += length;
    if (length < kShortest) continue;
    thread.direction[b] -= along / length;
    thread.direction[b + 1] += along / length;
  }
  return sum;
}

// How much shorter a unit of tension times the square of the sub-step makes the way [1/kg].
double mobility(const Model& model, const Suture& suture, const XpbdThread& thread) {
  double sum = 0;
  for (std::size_t b = 0; b < suture.bites.size(); ++b) {
    const Bite& bite = suture.bites[b];
    double part = 0;
    for (std::size_t k = 0; k < bite.particle.size(); ++k)
      part += bite.weight[k] * bite.weight[k] * model.inverse_mass[bite.particle[k]];
    sum += part * thread.direction[b].squaredNorm();
  }
  return sum;
}

}  // namespace

void XpbdPull::prepare(const Model& model, State& state) {
  thread_count_ = 0;
  pull_last_ = heldPosition(state);
  pull_sum_.setZero();
  if (!model.scene.suture || model.scene.suture->cinch_model != "thread") return;
  const std::vector<Suture>& sutures = state.procedure.sutures;
  for (std::size_t s = 0; s < sutures.size(); ++s) {
    if (!sutures[s].pulls()) continue;
    if (threads_.size() == thread_count_) threads_.emplace_back();
    XpbdThread& thread = threads_[thread_count_++];
    thread.suture = static_cast<int>(s);
    thread.length = thread.tension_sum = 0;
    for (double length : sutures[s].length) thread.length += length;
    thread.last = measure(sutures[s], state, thread);
  }
}

void XpbdPull::apply(const Model& model, double substep, State& state) {
  for (std::size_t t = 0; t < thread_count_; ++t) applyThread(model, threads_[t], substep, state);
  if (state.pull.holds()) applyPull(model, substep, state);
}

void XpbdPull::applyPull(const Model& model, double substep, State& state) {
  const PullSpring& pull = state.pull;
  const double h2 = substep * substep;
  double mobility = 0;
  for (std::size_t k = 0; k < pull.node.size(); ++k)
    mobility += h2 * pull.weight[k] * pull.weight[k] * model.inverse_mass[pull.node[k]];
  const Eigen::Vector3d force = kPullStiffness / (1 + kPullStiffness * mobility) * (pull.target - heldPosition(state));
  for (std::size_t k = 0; k < pull.node.size(); ++k)
    shift(pull.node[k], h2 * pull.weight[k] * model.inverse_mass[pull.node[k]] * force, substep, state);
  const Eigen::Vector3d place = heldPosition(state);
  state.energy.pull_work += force.dot(place - pull_last_);
  pull_sum_ += force;
  pull_last_ = place;
}

void XpbdPull::applyThread(const Model& model, XpbdThread& thread, double substep, State& state) {
  const Suture& suture = state.procedure.sutures[static_cast<std::size_t>(thread.suture)];
  const double h2 = substep * substep;
  const double way = measure(suture, state, thread), longer = way - thread.length;
  double shorter = 0;
  if (longer > 0) {
    const double give = h2 * mobility(model, suture, thread);
    const double tension = longer / (give + thread.length / model.scene.suture->thread_stiffness);
    shorter = give * tension;
    thread.tension_sum += tension;
    state.energy.thread_work -= tension * (way - shorter - thread.last);
    for (std::size_t b = 0; b < suture.bites.size(); ++b) {
      const Bite& bite = suture.bites[b];
      for (std::size_t k = 0; k < bite.particle.size(); ++k) {
        const double part = -tension * h2 * bite.weight[k] * model.inverse_mass[bite.particle[k]];
        shift(bite.particle[k], part * thread.direction[b], substep, state);
      }
    }
  }
  thread.last = way - shorter;
}

void XpbdPull::report(int count, State& state) const {
  if (state.pull.holds()) state.pull.force = pull_sum_ / count;
  for (std::size_t t = 0; t < thread_count_; ++t) {
    const XpbdThread& thread = threads_[t];
    Suture& suture = state.procedure.sutures[static_cast<std::size_t>(thread.suture)];
    std::fill(suture.tension.begin(), suture.tension.end(), thread.tension_sum / count);
    if (thread.tension_sum == 0) continue;
    // taut thread has slid until each segment has the part that the tissue leaves it
    double way = 0;
    for (std::size_t b = 0; b + 1 < thread.place.size(); ++b) way += (thread.place[b + 1] - thread.place[b]).norm();
    if (!(way > 0)) continue;
    for (std::size_t b = 0; b < suture.length.size(); ++b)
      suture.length[b] = thread.length * (thread.place[b + 1] - thread.place[b]).norm() / way;
  }
}

}  // namespace vibe
