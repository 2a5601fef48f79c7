#pragma once

#include "dynamics/implicit_step.hpp"

namespace vibe {

/// What the step just taken tells about the tool in the tissue: rows in force, forces and where they hold; goes to
/// scratch.touch.
void findToolContactRows(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper,
                         const StepReport& report, const State& state, ImplicitScratch& scratch);

}  // namespace vibe
