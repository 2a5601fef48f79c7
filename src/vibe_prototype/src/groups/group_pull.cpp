#include "groups/group_pull.hpp"
#include "arithmetic/turn.hpp"
#include "constraints/cinching.hpp"
#include "groups/group_draw.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace vibe::prototype {

namespace {

constexpr int kTurns = 4;           // improvements of a rotation; from step to step it changes little
constexpr double kMaxTurn = 0.5;    // of one improvement [rad]
constexpr double kMinTurn = 1e-12;  // rounding, not motion [rad]

// Mueller, Bender, Chentanez, Macklin 2016, "A robust method to extract the rotational part of deformations": also for
// groups on a line, about which nothing turns.
void turnWith(const std::vector<Eigen::Vector3d>& now, std::vector<Eigen::Vector3d>& offset) {
  for (int turn = 0; turn < kTurns; ++turn) {
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();
    double along = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      torque += offset[k].cross(now[k]);
      along += offset[k].dot(now[k]);
    }
    if (!(along > 0)) return;
    const double angle = std::min(torque.norm() / along, kMaxTurn);
    if (!(angle > kMinTurn)) return;
    const Eigen::Matrix3d rotation = rotationAbout(torque.normalized(), angle);
    for (Eigen::Vector3d& d : offset) d = rotation * d;
  }
}

void prepareGroup(const Model& model, State& state, int number, PulledGroup& pulled) {
  TissueGroup& group = state.procedure.sutures[static_cast<std::size_t>(number)].group;
  const std::size_t count = group.particle.size();
  pulled.suture = number;
  pulled.goal.resize(count);
  pulled.from.resize(count);
  pulled.stiffness.resize(count);
  const Eigen::Vector3d middle = middleOf(group, state);
  for (std::size_t k = 0; k < count; ++k) pulled.from[k] = particleAt(group.particle[k], state) - middle;
  turnWith(pulled.from, group.offset);
  for (std::size_t k = 0; k < count; ++k) {
    pulled.goal[k] = (1 - group.drawn) * group.offset[k];
    // of the order of what the wall itself sets against a particle's motion: stiffer would cost iterations
    pulled.stiffness[k] = model.scene.tissue.young_modulus * model.organ.thickness[group.particle[k]];
  }
}

// A displacement imposed on a particle is an impulse.
void shift(int i, const Eigen::Vector3d& by, double substep, State& state) {
  state.x[i] += by.x(), state.y[i] += by.y(), state.z[i] += by.z();
  state.vx[i] += by.x() / substep, state.vy[i] += by.y() / substep, state.vz[i] += by.z() / substep;
}

void applyGroup(const Model& model, const PulledGroup& pulled, const TissueGroup& group, double substep, State& state) {
  const Eigen::Vector3d middle = middleOf(group, state);
  const double h2 = substep * substep;
  const auto softened = [&](std::size_t k) {
    return pulled.stiffness[k] / (1 + pulled.stiffness[k] * h2 * model.inverse_mass[group.particle[k]]);
  };
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // of the forces on the particles if the middle stayed
  double stiffness = 0, mobility = 0;
  for (std::size_t k = 0; k < group.particle.size(); ++k) {
    sum += softened(k) * (pulled.goal[k] + middle - particleAt(group.particle[k], state));
    stiffness += softened(k);
  }
  for (std::size_t k = 0; k < group.middle.size(); ++k)
    mobility += h2 * group.weight[k] * group.weight[k] * model.inverse_mass[group.middle[k]];
  const Eigen::Vector3d back = -mobility / (1 + mobility * stiffness) * sum;
  sum += stiffness * back;
  for (std::size_t k = 0; k < group.particle.size(); ++k) {
    const int i = group.particle[k];
    const Eigen::Vector3d force = softened(k) * (pulled.goal[k] + middle + back - particleAt(i, state));
    shift(i, h2 * model.inverse_mass[i] * force, substep, state);
  }
  for (std::size_t k = 0; k < group.middle.size(); ++k)
    shift(group.middle[k], -group.weight[k] * h2 * model.inverse_mass[group.middle[k]] * sum, substep, state);
}

}  // namespace

void GroupPull::prepare(const Model& model, State& state) {
  count_ = 0;
  tissue_.clear();
  if (!model.scene.suture || model.scene.suture->cinch_model != "groups") return;
  std::vector<Suture>& sutures = state.procedure.sutures;
  for (std::size_t s = 0; s < sutures.size(); ++s) {
    if (!sutures[s].pulls() || sutures[s].group.empty()) continue;
    if (groups_.size() == static_cast<std::size_t>(count_)) groups_.emplace_back();
    prepareGroup(model, state, static_cast<int>(s), groups_[static_cast<std::size_t>(count_)]);
    tissue_.push_back(&sutures[s].group);
    ++count_;
  }
}

double GroupPull::evaluate(const double* positions4, float* gradient4) const {
  using Position = Eigen::Map<const Eigen::Vector3d>;
  double energy = 0;
  for (int g = 0; g < count_; ++g) {
    const PulledGroup& pulled = group(g);
    const TissueGroup& tissue = *tissue_[static_cast<std::size_t>(g)];
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < tissue.middle.size(); ++k)
      middle += tissue.weight[k] * Position(positions4 + 4 * tissue.middle[k]);
    for (std::size_t k = 0; k < tissue.particle.size(); ++k) {
      const int i = tissue.particle[k];
      const Eigen::Vector3d away = Position(positions4 + 4 * i) - middle - pulled.goal[k];
      const Eigen::Vector3d slope = pulled.stiffness[k] * away;
      energy += 0.5 * slope.dot(away);
      sum += slope;
      for (int axis = 0; axis < 3; ++axis) gradient4[4 * i + axis] += static_cast<float>(slope[axis]);
    }
    for (std::size_t k = 0; k < tissue.middle.size(); ++k)
      for (int axis = 0; axis < 3; ++axis)
        gradient4[4 * tissue.middle[k] + axis] -= static_cast<float>(tissue.weight[k] * sum[axis]);
  }
  return energy;
}

void GroupPull::applySubstep(const Model& model, double substep, State& state) const {
  for (int g = 0; g < count_; ++g) applyGroup(model, group(g), tissue(g, state), substep, state);
}

void GroupPull::report(State& state) const {
  for (int g = 0; g < count_; ++g) {
    const PulledGroup& pulled = group(g);
    Suture& suture = state.procedure.sutures[static_cast<std::size_t>(pulled.suture)];
    const Eigen::Vector3d middle = middleOf(suture.group, state);
    double sum = 0;
    for (std::size_t k = 0; k < pulled.goal.size(); ++k) {
      const Eigen::Vector3d now = particleAt(suture.group.particle[k], state) - middle;
      const Eigen::Vector3d half_way = 0.5 * (pulled.from[k] + now) - pulled.goal[k];
      state.energy.thread_work -= pulled.stiffness[k] * half_way.dot(now - pulled.from[k]);
      sum += pulled.stiffness[k] * (now - pulled.goal[k]).norm();
    }
    std::fill(suture.tension.begin(), suture.tension.end(), 0.5 * sum);
    // the thread lies straight from bite to bite and carries nothing of its own
    for (std::size_t b = 0; b < suture.length.size(); ++b)
      suture.length[b] = (bitePosition(suture.bites[b + 1], state.x, state.y, state.z) -
                          bitePosition(suture.bites[b], state.x, state.y, state.z))
                             .norm();
  }
}

}  // namespace vibe::prototype
