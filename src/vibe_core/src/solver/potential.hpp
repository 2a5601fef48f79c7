#pragma once

#include "solver/stepper_workspace.hpp"
#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// Pressure of the gas in a closed shell as a function of its volume, during one step. It falls with the volume or is
/// constant, so it is the negative derivative of a convex energy.
///
/// With an insufflator (Control::Regulated) the amount at the end of a step lies between two limits, and the
/// insufflator keeps its set point within them:
///   p(V) = clamp(p_set, n_min / V - p_ambient, n_max / V - p_ambient).
/// The forces of a step act at a point between its ends. The limits there are interpolated in time.
class GasLaw {
 public:
  /// @param load  kept by reference: the pressure may change while a volume is prescribed
  /// @param part  of the step after which its forces act
  explicit GasLaw(const GasLoad& load, double part = 1);

  /// Gauge pressure [Pa].
  double pressure(double volume) const;
  /// Up to a constant; its negative derivative is the pressure [J].
  double energy(double volume) const;
  /// How fast the pressure falls with the volume; infinite where the volume is prescribed [Pa/m^3].
  double stiffness(double volume) const;

  /// The piece of the law of an insufflator: the limit of the amount that acts at a volume. Other laws have one piece.
  enum class Piece { Least, Kept, Most };
  Piece pieceAt(double volume) const;
  /// The linear continuation of a piece from a volume, whether or not the piece acts there.
  struct Line {
    double pressure = 0;   ///< [Pa]
    double stiffness = 0;  ///< [Pa/m^3]
  };
  Line lineOf(Piece piece, double volume) const;

 private:
  double closedEnergy(double amount, double from, double volume) const;

  const GasLoad& load_;
  double amount_min_, amount_max_;  // absolute pressure times volume [J]
  double volume_min_, volume_max_;  // between them the set point is kept [m^3]
};

/// What a step minimises: elastic energy, work on a constant stress, gas, foundation, dead loads, and half the inertia
/// times the squared distance from where inertia alone would put the nodes.
class Potential {
 public:
  /// @param inertia  mass times this is the spring to z_hat [1/s^2]; 0: a static problem
  /// @param part     of the step after which its forces act, see GasLaw
  Potential(const ElasticBody& body, const BodyLoads& loads, double inertia, StepperWorkspace& scratch, double part = 1)
      : body_(body),
        gas_(loads.gas),
        gas_law_(loads.gas, part),
        stress_(loads.stress),
        extra_(loads.extra),
        inertia_(inertia),
        scratch_(scratch),
        at_(scratch.iterate),
        system_(scratch.system) {}

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
  double addElements(std::vector<float>& gradient, double& volume);
  double gasEnergy();
  double addBodyTerms(const std::vector<double>& z, std::vector<float>& gradient);
  double addRareTerms(const std::vector<double>& z, std::vector<float>& gradient) const;
  double addExtra(const std::vector<double>& z, std::vector<float>& gradient) const;
  double addSprings(const std::vector<double>& z, std::vector<float>& gradient) const;

  const ElasticBody& body_;
  const GasLoad& gas_;
  GasLaw gas_law_;
  const std::vector<float>* stress_;
  const EnergyTerm* extra_;
  double inertia_;
  StepperWorkspace& scratch_;
  Iterate& at_;
  const RowSystem& system_;
  double noise_ = 0, elastic_ = 0;
};

}  // namespace vibe
