#pragma once
#include <Eigen/Core>
#include <string>

namespace vibe {

struct Model;
struct State;
struct StepInput;

/// Why the tissue cannot be pulled at this particle, as the end of a sentence; empty if it can.
std::string pullRejection(const Model& model, int particle);

/// Takes hold, lets go, or moves the target by a step of model.scene.step_period, as the input says. A new hold begins
/// without force. A particle that cannot be pulled, or a target that is not finite, lets go.
void movePullSpring(const Model& model, const StepInput& input, State& state);

/// Place of the held patch in world [m]; zero where nothing is held.
Eigen::Vector3d heldPosition(const State& state);

}  // namespace vibe
