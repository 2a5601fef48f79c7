#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/state/hold_memory.hpp"
#include "vibe_core/state/impedance_memory.hpp"
#include "vibe_core/state/procedure_state.hpp"
#include "vibe_core/state/relaxation_memory.hpp"
#include "vibe_core/state/stepper_memory.hpp"
#include "vibe_core/state/tool_displacement.hpp"

namespace vibe {

constexpr double kPullStiffness = 300;  ///< between patch and target; design choice [N/m]
constexpr double kPullForce = 5;        ///< maximum; the target is kept near enough for it. Design choice [N]
constexpr double kPullSpeed = 0.25;     ///< maximum, of the target, so that a jump of the mouse tears nothing [m/s]
constexpr double kPullRadius = 6e-3;    ///< of the patch around the particle, in the rest shape [m]

/// Pulls the tissue at one place: a spring from the weighted mean position of a patch of the wall to a target that
/// follows StepInput::pull_target.
struct PullSpring {
  int particle = -1;                                 ///< at the centre of the patch; -1: nothing is held
  std::vector<int> node;                             ///< particles of the patch, ascending, without fixed ones
  std::vector<double> weight;                        ///< of each in the mean position, sum 1
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< end of the spring, world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< spring on tissue in the last step, world [N]

  bool holds() const { return !node.empty(); }  ///< it pulls on tissue
};

/// A particle of the disc of wall that the helix holds. The helix carries along the mean place of the disc and its mean
/// stretch and turn, so a single particle may move against it.
struct GripPoint {
  int particle = -1;      ///< its number
  Eigen::Vector3d local;  ///< where it was when the helix took hold, in the frame of the link that carries it [m]
  double weight = 1;      ///< its share of the disc; sum over the grip 1
};

/// Weight from which a particle counts as held by itself, where only whole particles can be: a quarter of the greatest.
/// Design choice: those of which less belongs to the disc lie outside of it and give way.
inline double wholeWeight(const std::vector<GripPoint>& grip) {
  double greatest = 0;
  for (const GripPoint& point : grip) greatest = point.weight > greatest ? point.weight : greatest;
  return greatest / 4;
}

/// Sums since the start [J], see energyBalance(). Shape matching knows works and damping_loss only.
struct EnergyAccount {
  double tool_work = 0;  ///< done by the tool (contact and grip): its forces times its own motion
  double hand_work = 0;  ///< done by the hand on the tool: tool_work, scope_loss and the energy of its springs
  /// Dissipated by the dampers of a scope that gives way. Where the guard stops the tool, or a step does not arrive,
  /// springs and forces are not in equilibrium: then it is all of hand_work beyond tool_work and the springs' energy.
  double scope_loss = 0;
  double gas_work = 0;         ///< done by the gas on the wall
  double thread_work = 0;      ///< done by threads on the tissue
  double pull_work = 0;        ///< done by the pull spring and by breathing on the tissue
  double friction_loss = 0;    ///< tool_work that does not reach the tissue: dissipated where the tool slides
  double damping_loss = 0;     ///< dissipated by mass damping
  double viscous_loss = 0;     ///< dissipated by stiffness damping
  double contact_loss = 0;     ///< dissipated by walls in contact
  double contact_energy = 0;   ///< stored by walls in contact now, not a sum
  double numerical_loss = 0;   ///< dissipated by the time scheme
  double correction_work = 0;  ///< done by corrections after a step that keep walls and tools apart, and by recoveries
  double residual_work = 0;    ///< done by forces that the iterations of a step left unbalanced
};

/// Interruptions of a contact shorter than this do not end it [s].
constexpr double kContactGap = 0.25;

/// The organ's own motion, beside what follows from the time. A state in which it is as here has the hash that it would
/// have without: see hash().
struct MotionState {
  bool held = false;       ///< the breath, in the last step
  double held_time = 0;    ///< for which it was held so far [s]
  double muscle_work = 0;  ///< done by contraction waves on the tissue, a sum like those of EnergyAccount [J]
};

/// Where the tip of the scope was when it was last looked for.
struct LumenState {
  bool left = false;  ///< outside of the organ, after it has entered
};

/// Everything that changes. A snapshot is a copy; equal states have equal futures. Every member of it, and of the
/// structs in it, is in a table of state_fields.hpp, from which hash, snapshot and comparison follow.
struct State {
  std::int64_t step = 0;     ///< number of steps since the initial state
  double time = 0;           ///< step * step_period [s]
  std::uint64_t seed = 1;    ///< with which `random` started
  std::uint64_t random = 0;  ///< state of the generator

  // particles, structure of arrays, (particle count)
  std::vector<double> x, y, z;         ///< positions [m]
  std::vector<double> vx, vy, vz;      ///< velocities [m/s]
  std::vector<double> ax, ay, az;      ///< accelerations; 0 with solvers that do not use them [m/s^2]
  std::vector<double> qw, qx, qy, qz;  ///< unit quaternion: rotation of the particle's surroundings from rest
  std::vector<double> wx, wy, wz;      ///< its angular velocity, in world [rad/s]

  double gas_amount = 0;  ///< absolute pressure times volume [Pa m^3 = J]
  double pressure = 0;    ///< gauge [Pa]
  double volume = 0;      ///< of the lumen [m^3]
  /// The insufflator is on and came within 1 % of its set point (at least 1 Pa), and has not been beyond 5 % since (at
  /// least 5 Pa).
  bool pressure_reached = false;

  std::array<double, kJointCount> joints{};  ///< of the hand: positions of the tool's inputs, limits applied [m], [rad]
  ToolDisplacement tool_displacement{};      ///< of the tool from these positions; 0 with a rigid one
  std::array<double, kScopeJointCount>
      hand_effort{};                     ///< of the hand on the scope's joints, mean over the step [N], [N m]
  std::array<int, kJointCount> stall{};  ///< steps in which the hand does not push a joint that tissue has stopped,
                                         ///< with the sign of its motion
  int blocked_steps = 0;                 ///< in a row in which the wall has stopped the whole tool
  std::vector<GripPoint> grip;           ///< what the helix holds; empty: nothing
  bool helix_pressed = false;            ///< button state of the last step, for edges
  bool in_contact = false;               ///< the tool touches tissue, or did within the last kContactGap
  double untouched_time = 0;             ///< since the tool last touched tissue, while in_contact [s]

  Eigen::Vector3d tool_force = Eigen::Vector3d::Zero();   ///< tissue on tool, mean over the step, in scope_tip [N]
  Eigen::Vector3d tool_torque = Eigen::Vector3d::Zero();  ///< about the origin of scope_tip, in scope_tip [N m]
  /// Of the tissue on the ways in which the tool gives way, with the forces of the step where it ends, in the order of
  /// tool_displacement; 0 with a rigid one [N], [N m], [N m], [N m], then [N m^2].
  std::array<double, kYieldDofs> tool_load{};
  double grip_force = 0;  ///< magnitude of the force on the grip [N]
  int contact_count = 0;  ///< points where the tool touches the wall; shape matching: particles that it touches

  PullSpring pull;              ///< pulls the tissue from outside
  MotionState motion;           ///< of the organ by itself
  HoldMemory hold;              ///< of a hand that holds still; it counts in the hash as `motion` does
  LumenState lumen;             ///< where the tip is; it counts in the hash as `motion` does
  RelaxationMemory relaxation;  ///< of the wall; it counts in the hash as `motion` does

  ProcedureState procedure;  ///< marks, needle, sutures and bleeding

  EnergyAccount energy;  ///< works and losses; they start from 0 again where the tissue does (EventDetail::NotFinite)

  StepperMemory solver;       ///< of the implicit solver; empty with another
  ImpedanceMemory impedance;  ///< of the implicit solver's tool impedance; empty with another
};

}  // namespace vibe
