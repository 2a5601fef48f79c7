#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "vibe_core/haptics/tool_impedance.hpp"

namespace vibe {

struct Model;
struct State;
class ToolMotion;
class ThreadPool;

/// What one step did besides changing the state.
struct StepReport {
  Eigen::Vector3d tool_force = Eigen::Vector3d::Zero();   ///< tissue on tool, mean over the step, in world [N]
  Eigen::Vector3d tool_torque = Eigen::Vector3d::Zero();  ///< about scope_tip, mean over the step, in world [N m]
  Eigen::Vector3d grip_force = Eigen::Vector3d::Zero();   ///< part of tool_force that acts on the helix [N]
  std::optional<ToolImpedance> tool_impedance;  ///< nothing where nothing is touched, or the solver cannot tell
  int contact_count = 0;                        ///< most particles touched at once
  int iterations = 0;                           ///< of an implicit solver
  bool fallback = false;                        ///< the step needed backward Euler and more iterations
  bool put_back = false;                        ///< a state beyond hope began its way back to rest
  int speed_limited = 0;                        ///< times a particle's speed had to be limited
};

/// Scratch memory of a solver; carries nothing from one step to the next.
class SolverScratch {
 public:
  virtual ~SolverScratch() = default;
};

/// Advances the tissue by one step under everything that acts on it: its own elasticity, gas, weight, foundation, the
/// moving tool and what the helix holds. Constant; all memory is in State and SolverScratch, so one solver serves many
/// states. An explicit, a position-based and an implicit method fit alike: the step is the solver's to divide.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual std::string name() const = 0;
  /// Divides the step into model.substeps explicit ones.
  virtual bool usesSubsteps() const { return false; }
  virtual std::unique_ptr<SolverScratch> makeScratch(const Model& model) const = 0;

  /// @param motion  path of the tool during the step; null without a scope
  /// Changes positions, velocities, orientations, gas and energy account of the state; not its clock, joints or grip.
  virtual void advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                       SolverScratch& scratch, ThreadPool& pool, StepReport& report) const = 0;
};

}  // namespace vibe
