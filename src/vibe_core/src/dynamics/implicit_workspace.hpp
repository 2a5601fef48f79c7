#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "haptics/impedance_estimator.hpp"
#include "solver/sum_term.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/tool_guard.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Buffers of ImplicitSolver.
struct ImplicitWorkspace : SolverWorkspace {
  std::shared_ptr<StepperWorkspace> stepper;
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;  // in the order in which they are asked
  BodyLoads loads;
  SumTerm terms;                                   // energies of the blocks
  std::array<std::vector<double>, 9> start;        // positions, velocities, accelerations before it [m], [s]
  std::array<std::vector<double>, 6> uncorrected;  // positions and velocities before corrections [m], [m/s]
  std::optional<ToolGuard> guard;                  // empty without a tool
  std::vector<int> held;                           // particles that the helix holds
  std::vector<ToolTouch> touches;                  // of the last step
  std::unique_ptr<ImpedanceEstimator> impedance;   // null without a tool
  ToolContactRows tool_rows;
};

/// Positions, velocities, accelerations of the nodes.
constexpr std::size_t kMotion = 9;
constexpr std::array<std::vector<double> State::*, kMotion> kMotionOf{
    &State::x, &State::y, &State::z, &State::vx, &State::vy, &State::vz, &State::ax, &State::ay, &State::az};

inline MotionView motionOf(State& state) {
  return {{state.x.data(), state.y.data(), state.z.data()},
          {state.vx.data(), state.vy.data(), state.vz.data()},
          {state.ax.data(), state.ay.data(), state.az.data()}};
}

/// Velocities and accelerations become zero.
void stopMotion(State& state);

/// Straight paths of the nodes from the start of the step to where they are.
SurfacePath pathOfStep(const ImplicitWorkspace& scratch, const State& state);

}  // namespace vibe
