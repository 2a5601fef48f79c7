#pragma once
#include <Eigen/Core>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Mechanical energy of the tissue, by kind [J]. The gas is isothermal; its share is counted as work in
/// state.energy.gas_work and not as a potential here.
struct Energies {
  double kinetic = 0;     ///< of the particles that are not held in place
  double elastic = 0;     ///< stored in the wall, see TissueModel::energy()
  double gravity = 0;     ///< zero at rest; 0 where the foundation carries the weight
  double foundation = 0;  ///< of its springs, about the places at rest even while it moves with the breath
  double contact = 0;     ///< of walls that touch each other
  double total() const { return kinetic + elastic + gravity + foundation + contact; }  ///< the sum of all five [J]
};
/// Of a state. Evaluates the elastic law of the whole wall; contact is what the last step left in state.energy.
Energies energies(const Model& model, const State& state);
/// The same without elastic and contact energy, which are the expensive ones.
Energies energiesBesideElastic(const Model& model, const State& state);

/// Kinetic and potential energy, minus the work of tool, gas, threads, pull spring, muscle, corrections and residuals,
/// plus all losses in state.energy [J]. With an implicit solver it is constant up to the error of the trapezoidal rule
/// for the elastic energy over a step, and up to rounding. Shape matching has no account of stiffness_damping and of
/// its own numerical damping, which lower it.
double energyBalance(const Model& model, const State& state);

/// Sum of mass times velocity over the free particles [kg m/s].
Eigen::Vector3d linearMomentum(const Model& model, const State& state);

/// Sum of position x mass times velocity over the free particles, about the origin of world [kg m^2/s].
Eigen::Vector3d angularMomentum(const Model& model, const State& state);

}  // namespace vibe
