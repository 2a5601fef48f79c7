#pragma once

#include "solver/stepper_workspace.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

/// One step of generalised-alpha (Chung, Hulbert 1993, doi 10.1115/1.2900803) or backward Euler written for one
/// unknown, the acceleration a' at the end of the step:
///   x' = x_free + x_gain a',   v' = v_free + v_gain a',   z = z_free + z_gain a'
/// where z is the point at which the forces are evaluated (between the ends of the step, and ahead by the damping
/// time). Balance: inertia (z - z_hat) = F(z) per unit mass, with the mass damping in it.
struct TimeScheme {
  explicit TimeScheme(const StepSettings& settings, double mass_damping, double stiffness_damping);

  double h;
  double alpha_m = 0, alpha_f = 0, gamma = 1, beta = 1;
  double x_gain, v_gain, z_gain;
  double inertia;  ///< [1/s^2]
  /// Part of the step after which the forces act [1].
  double part() const { return 1 - alpha_f; }
  double rate, time;

  /// a * acceleration + v * velocity + position
  struct Blend {
    double v, a;
    double operator()(double x, double vel, double acc) const { return x + v * vel + a * acc; }
  };
  Blend free_x;     ///< x' for a' = 0
  Blend free_z;     ///< z for a' = 0
  Blend hat_z;      ///< where z would be without forces
  double free_v_a;  ///< v' for a' = 0 is v + free_v_a a
};

/// Moves the scratch's z of a free body rigidly by what its velocities and accelerations make of it: however far, that
/// does not strain. The translation and the turn have the linear and angular momentum of the nodes' own moves.
void moveRigidly(const ElasticBody& body, const MotionView& motion, const TimeScheme& scheme,
                 StepperWorkspace& scratch);

class StepperWorkspace;

/// Moves the nodes to the end of the step and sums up the works. Sets the works of the loads.
/// @param mean_velocity  the nodes end with the mean velocity of the step and no acceleration: what iterations that
///                       ended early lack would be amplified by the velocity of the scheme
StepWork finishMotion(const ElasticBody& body, const TimeScheme& scheme, const MotionView& motion, BodyLoads& loads,
                      bool mean_velocity, StepperWorkspace& scratch);

/// The constraints, contacts and threads of the loads as rows for the positions at which forces are evaluated, in the
/// scratch's rows. The lengths of segments of thread are linearised about the given positions.
void buildRows(const BodyLoads& loads, const MotionView& motion, StepperWorkspace& scratch);
/// The values that the rows have in the equilibrium itself, in the scratch's target.
void setEquilibriumTargets(const BodyLoads& loads, StepperWorkspace& scratch);
/// The same for a step: rows are met at its end, so that z has to move by the scheme's ratio of gains times as much.
/// Scales the compliances of the rows in the same way.
/// @param in_factor  stiffness that the factor has beside that of the elements
void setStepTargets(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme,
                    const std::vector<StiffnessCoupling>& in_factor, StepperWorkspace& scratch);
/// Contacts that count in a step at most. Design choice: three times what a press of 3 N by the scope touches; the time
/// of a solution grows with the third power of the rows that act.
constexpr std::size_t kMaxContacts = 128;
/// Those with friction, which have three rows. Design choice: what a usual press has within reach; in the cases that
/// have more, friction on all of them changes the force on the tool by no more than the last bound does.
constexpr std::size_t kMaxWithFriction = 32;
/// Bounds the work of a step: the deepest contacts at the scratch's z keep their friction, further ones up to
/// kMaxContacts only their normal, and the rest neither rows nor force. Needs the targets.
/// @returns whether rows have other numbers now; their targets are to be set again
bool limitContacts(StepperWorkspace& scratch);
/// How deep the contacts that do not count are in the tool at z, moved by the forces of the last elimination [m].
double depthLeftOut(const std::vector<double>& z, const StepperWorkspace& scratch);
/// Where a contact that does not count would be deep in the tool at z, those that are deepest take the rows of contacts
/// without force. Sets the targets again.
/// @returns whether rows have changed
bool exchangeContacts(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme,
                      const std::vector<double>& z, StepperWorkspace& scratch);
/// The forces of contacts back to the loads, and how far the tool yields.
void storeToolForces(const StepperWorkspace& scratch, BodyLoads& loads);
/// All forces of rows back to the loads, and how far the threads slid.
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void storeForces(const StepperWorkspace& scratch, double gain, BodyLoads& loads);

}  // namespace vibe
