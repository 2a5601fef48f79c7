#pragma once

#include "dynamics/implicit_workspace.hpp"

namespace vibe {

struct Model;

/// The touches of the last step as rows for the tool's impedance, with the motion of their targets per motion of the
/// tool: from scratch.touches to scratch.tool_rows.
void findToolContactRows(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper,
                         const StepReport& report, ImplicitWorkspace& scratch);

}  // namespace vibe
