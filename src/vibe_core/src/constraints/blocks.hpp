#pragma once

#include <memory>

#include <Eigen/Core>

#include "vibe_core/constraints/constraint_registry.hpp"

namespace vibe {

/// Particles that the tool touches: they stay outside its shapes, with Coulomb friction (scene.scope->friction). The
/// ends of the organ that are open pass through the tool; held particles do not touch. Null without a tool.
std::unique_ptr<ConstraintBlock> makeToolContactBlock(const Model& model);

/// What the helix holds: each held particle is at its point of the link that carries the helix, at the end of the step.
/// Null without a tool.
std::unique_ptr<ConstraintBlock> makeGripBlock(const Model& model);

/// Sutures that pull by their thread (suture.cinch_model: thread): an attachment point per bite, a thread per suture.
/// Null in a scene with other sutures or none.
std::unique_ptr<ConstraintBlock> makeThreadBlock(const Model& model);

/// Parts of the wall that meet, see SelfContact. Null without tissue.self_contact.
std::unique_ptr<ConstraintBlock> makeSelfContactBlock(const Model& model);

/// The diaphragm, see breathingShift(): a force on every particle that is held by the foundation, and the position of
/// the end of the oesophagus if it is attached. What it does to the tissue counts as pull_work; the work at the
/// oesophagus, which no force tells, is in numerical_loss. Null in a scene that does not breathe.
std::unique_ptr<ConstraintBlock> makeBreathingBlock(const Model& model);

/// The contraction waves of the wall, see WallMuscle. Their work is MotionState::muscle_work. Null in a scene without.
std::unique_ptr<ConstraintBlock> makePeristalsisBlock(const Model& model);

/// The stress that the wall has lost by relaxation, see RelaxationScene. Null where the wall is elastic.
std::unique_ptr<ConstraintBlock> makeRelaxationBlock(const Model& model);

/// The gas in the lumen, isothermal, and the insufflator. Null in a scene without gas.
std::unique_ptr<ConstraintBlock> makeGasBlock(const Model& model);

/// The spring from outside, see PullSpring: it acts on the weighted mean of a patch of the wall.
std::unique_ptr<ConstraintBlock> makePullSpringBlock(const Model& model);

/// How a point on a link of the tool moves with the tool's displacement: ContactConstraint::yield, and its rows those
/// of LinearConstraint::yield. Zero with a rigid tool. It is that of the middle of the step, so that the work at the
/// joints is the work at the point to third order.
/// @param point  in world, at the poses context.tool->end [m]
Eigen::Matrix<double, 3, kYieldDofs> toolYield(const StepContext& context, int link, const Eigen::Vector3d& point);

}  // namespace vibe
