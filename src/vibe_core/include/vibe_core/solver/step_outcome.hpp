#pragma once

namespace vibe {

/// What the forces of a step did, and what became of it. A step from x to x' balances
///   M a_m + c M v_f + grad W(z) = sum of the other forces at z + r
/// at the point z, where a_m and v_f are the mean acceleration and velocity of the scheme, c is the mass damping and r
/// is what the iterations leave. Each force is multiplied by x' - x; the works of rows are in the loads.
///
/// The force of the elements f(s) . (x' - x) along the step, s from 0 at x to 1 at x', comes from the two points that
/// the step has evaluated in any case, its first and its last: a parabola through both forces, with the difference of
/// the energies as its integral. It gives the losses:
///   stiffness damping  f(z) - f(part),  part: of the step after which the forces act
///   scheme             f(part) - integral of f + M a_m . (x' - x) - change of the kinetic energy
struct StepWork {
  double gas = 0;           ///< done by the gas on the body [J]
  double extra = 0;         ///< done by BodyLoads::extra on the body [J]
  double mass_damping = 0;  ///< dissipated by mass damping [J]
  double viscous = 0;       ///< dissipated by stiffness damping [J]
  double numerical = 0;     ///< dissipated by the time scheme [J]
  double stored = 0;        ///< change of the energy of elements and foundation, as foreseen [J]
  double to_first = 0;      ///< the same from the start of the step to its first point of evaluation [J]
  double residual = 0;      ///< done by what the iterations left unbalanced [J]
};

/// What a step or a solve did.
struct StepOutcome {
  int iterations = 0;
  double last_move = 0;      ///< farthest a node moved in the last iteration [m]
  int refactorisations = 0;  ///< static solves only
  bool converged = false;    ///< last_move is below the tolerance
  bool fallback = false;     ///< backward Euler, because of the settings or because one of the last did not arrive
  bool arrived = true;       ///< false: the step ended because its work is limited; the next steps go on
  double residual = 0;  ///< how far the next iteration would have moved a node, or a contact or thread is violated [m]
  int evaluations = 0;  ///< of the energy and its gradient
  int solves = 0;       ///< with the factor
  bool finite = true;   ///< false: the state is not usable
  StepWork work;        ///< of a step
};

}  // namespace vibe
