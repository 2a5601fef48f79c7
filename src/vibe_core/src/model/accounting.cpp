#include "vibe_core/model/accounting.hpp"

#include <Eigen/Geometry>

namespace vibe {

namespace {
Eigen::Vector3d position(const State& s, int i) {
  return {s.x[i], s.y[i], s.z[i]};
}
Eigen::Vector3d velocity(const State& s, int i) {
  return {s.vx[i], s.vy[i], s.vz[i]};
}
}  // namespace

Energies energiesBesideElastic(const Model& model, const State& state) {
  Energies e;
  const double foundation = model.scene.foundation ? model.scene.foundation->stiffness : 0;
  for (int i = 0; i < model.particle_count; ++i) {
    if (model.inverse_mass[i] == 0) continue;
    const Eigen::Vector3d shift = position(state, i) - model.organ.surface.vertices[i];
    e.kinetic += 0.5 * model.mass[i] * velocity(state, i).squaredNorm();
    e.gravity -= model.mass[i] * model.unbalanced_gravity.dot(shift);
    e.foundation += 0.5 * foundation * model.area[i] * shift.squaredNorm();
  }
  return e;
}

Energies energies(const Model& model, const State& state) {
  Energies e = energiesBesideElastic(model, state);
  e.elastic = model.tissue->energy(state);
  e.contact = state.energy.contact_energy;
  return e;
}

double energyBalance(const Model& model, const State& state) {
  const EnergyAccount& e = state.energy;
  const double put_in = e.tool_work + e.gas_work + e.thread_work + e.pull_work + state.motion.muscle_work;
  const double lost =
      e.friction_loss + e.damping_loss + e.viscous_loss + e.contact_loss + e.numerical_loss + state.relaxation.loss;
  return energies(model, state).total() - put_in + lost - e.correction_work - e.residual_work;
}

Eigen::Vector3d linearMomentum(const Model& model, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.particle_count; ++i)
    if (model.inverse_mass[i] != 0) sum += model.mass[i] * velocity(state, i);
  return sum;
}

Eigen::Vector3d angularMomentum(const Model& model, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.particle_count; ++i)
    if (model.inverse_mass[i] != 0) sum += position(state, i).cross(model.mass[i] * velocity(state, i));
  return sum;
}

}  // namespace vibe
