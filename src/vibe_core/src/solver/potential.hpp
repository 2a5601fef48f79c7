#pragma once

#include "solver/gas_law.hpp"
#include "solver/stepper_workspace.hpp"

namespace vibe {

/// What a step minimises: elastic energy, gas, foundation, dead loads, and half the inertia times the squared distance
/// from where inertia alone would put the nodes.
class Potential {
 public:
  /// @param inertia  mass times this is the spring to z_hat [1/s^2]; 0: a static problem
  /// @param part     of the step after which its forces act, see GasLaw [1]
  Potential(const ElasticBody& body, const BodyLoads& loads, double inertia, StepperWorkspace& scratch, double part = 1)
      : body_(body),
        gas_(loads.gas),
        gas_law_(loads.gas, part),
        extra_(loads.extra),
        inertia_(inertia),
        scratch_(scratch) {}

  /// Value [J] at z; the gradient [N] goes to `gradient` (4 per node). Also sets the scratch's volume, pressure and
  /// volume gradient.
  double evaluate(const std::vector<double>& z, std::vector<float>& gradient);
  const GasLaw& gas() const { return gas_law_; }
  /// Sets the scratch's volume and pressure for a move that changes the volume by `change` and is not evaluated [m^3].
  void moveVolume(double change);
  double elasticEnergy() const { return elastic_; }  ///< part of the last value [J]
  double noise() const { return noise_; }            ///< rounding error of the last value [J]

 private:
  void startSums(const std::vector<double>& z, std::vector<float>& gradient);
  double gasEnergy();
  double addBodyTerms(const std::vector<double>& z, std::vector<float>& gradient);
  double addRareTerms(const std::vector<double>& z, std::vector<float>& gradient) const;
  double addExtra(const std::vector<double>& z, std::vector<float>& gradient) const;
  double addSprings(const std::vector<double>& z, std::vector<float>& gradient) const;

  const ElasticBody& body_;
  const GasLoad& gas_;
  GasLaw gas_law_;
  const EnergyTerm* extra_;
  double inertia_;
  StepperWorkspace& scratch_;
  double noise_ = 0, elastic_ = 0;
};

}  // namespace vibe
