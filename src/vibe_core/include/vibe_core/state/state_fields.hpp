#pragma once

#include <cstdint>

#include "vibe_core/files/fields.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Version of StepInput's fields, which recordings carry. Raise it with every change of the list below.
///   1: joints and buttons
///   2: with pull_particle and pull_target
///   3: with breath
constexpr std::uint32_t kStepInputVersion = 3;

VIBE_FIELDS(StepInput, joints, buttons, pull_particle, pull_target, breath);

/// Version of the fields of State and of the layout of snapshots, which carry it. Raise it with every change of the
/// lists below.
constexpr std::uint32_t kStateVersion = 12;

VIBE_FIELDS(Bite, particle, weight, time, depth, thickness, region, wall, along);
VIBE_FIELDS(TissueGroup, particle, offset, middle, weight, drawn);
VIBE_FIELDS(Suture, stage, bites, length, tension, taken, technique, technique_margin, transitions, corrected_technique,
            printed_technique, pulled, cinch_tension, begin, end, tear_outs, group);
VIBE_FIELDS(Bleeding, suture, bite, particle, brisk, begin, rate, amount, overdue);
VIBE_FIELDS(ProcedureState, phase, pressed, heat, dose, grade, beam_energy, base_x, base_y, base_z, grip_rotation,
            grip_turns, arm_closed, needle_on_arm, needle_loaded, pierced, pending, sutures, thread_used, bleedings,
            blood_lost);
VIBE_FIELDS(PullSpring, particle, node, weight, target, force);
VIBE_FIELDS(MotionState, held, held_time, muscle_work);
VIBE_FIELDS(KeptContact, node, weight, shape, nearest, clearance, force, place, normal, tool_point);
VIBE_FIELDS(HoldMemory, steps, contacts);
VIBE_FIELDS(LumenState, left);
VIBE_FIELDS(RelaxationMemory, stress, overstress, held, energy, loss);
VIBE_FIELDS(GripPoint, particle, local, weight);
VIBE_FIELDS(EnergyAccount, tool_work, hand_work, scope_loss, gas_work, thread_work, pull_work, friction_loss,
            damping_loss, viscous_loss, contact_loss, contact_energy, numerical_loss, correction_work, residual_work);
VIBE_FIELDS(StiffnessCoupling, node, weight, stiffness);
VIBE_FIELDS(StepperMemory, linearization_point, next, couplings, next_couplings, linearization_id, next_id, steps, due,
            elastic_energy, usual_length, rest_steps, recovery_steps, jammed_steps, backward_euler_steps);
VIBE_FIELDS(ImpedanceBasis, id, positions, gas_direction, gas_stiffness, node, direction, row_motion);
VIBE_FIELDS(SlopeMemory<3>, known, has_pair, place, force, step, change);
VIBE_FIELDS(SlopeMemory<kScopeJointCount>, known, has_pair, place, force, step, change);
VIBE_FIELDS(ImpedanceMemory, last_step, next_renewal, current, next, last_nodes, has_last, last_place, last_speed,
            last_force, last_jump, slope, joint_slope);
VIBE_FIELDS(State, step, time, seed, random, x, y, z, vx, vy, vz, ax, ay, az, qw, qx, qy, qz, wx, wy, wz, gas_amount,
            pressure, volume, pressure_reached, joints, tool_displacement, hand_effort, stall, blocked_steps, grip,
            helix_pressed, in_contact, untouched_time, tool_force, tool_torque, tool_load, grip_force, contact_count,
            pull, motion, hold, lumen, relaxation, procedure, energy, solver, impedance);

}  // namespace vibe
