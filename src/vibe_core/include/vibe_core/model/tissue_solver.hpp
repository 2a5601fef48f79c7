#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/clocks/step_stages.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/solver/step_ways.hpp"
#include "vibe_core/tool/tool_model.hpp"
#include "vibe_core/tool_contact/tool_contact.hpp"

namespace vibe {

struct Model;
struct State;
class ToolMotion;
class ThreadPool;

/// Results of one step beside the new state.
struct StepReport {
  Eigen::Vector3d tool_force = Eigen::Vector3d::Zero();   ///< tissue on tool, mean over the step, in world [N]
  Eigen::Vector3d tool_torque = Eigen::Vector3d::Zero();  ///< about scope_tip, mean over the step, in world [N m]
  Eigen::Vector3d grip_force = Eigen::Vector3d::Zero();   ///< part of tool_force that acts on the helix [N]
  std::vector<ToolContact> contacts;                      ///< where tool_force acts, as their sum
  std::optional<ToolImpedance> tool_impedance;            ///< empty without contact, or if the solver computes none
  ToolDisplacement tool_displacement{};                   ///< in: if nothing acts on the tool; out: at the end
  std::array<double, kYieldDofs> tool_load{};             ///< see State [N], [N m]
  std::array<double, kScopeJointCount> hand_effort{};     ///< of the hand on the joints, mean over the step [N], [N m]
  std::array<int, kJointCount> stopped{};                 ///< joints that tissue has stopped: sign of their motion
  int blocking_particle = -1;  ///< nearest to what has stopped the whole tool; -1: it goes on, or rests by itself
  int contact_count = 0;       ///< see State
  StepWays ways;               ///< that the step took where something was not as foreseen
  int solves = 0;              ///< of an implicit solver: 1, more where the wall stops the tool or it ends elsewhere
  int iterations = 0;          ///< of an implicit solver, in the last of them
  int evaluations = 0;         ///< of the elastic energy, by an implicit solver, in all of them
  int rows = 0;                ///< of contacts, grip and threads, in an implicit solver
  int limited = 0;             ///< contacts of the tool without friction or force, because there were too many
  int wall_pairs = 0;          ///< pairs of points of walls that act on each other
  StageTimes stage_times{};    ///< zero unless they are measured [s]
  double residual = 0;         ///< of a further iteration, or of contacts and threads [m]
  bool arrived = true;         ///< false: the limit of work left much of the step to the next
  bool fallback = false;       ///< backward Euler, because one of the last did not arrive
  bool put_back = false;       ///< the state was not usable; its recovery to rest began
  int speed_limited = 0;       ///< how often the speed of a particle was limited

  /// As before the first step; the list keeps its memory.
  void clear() {
    std::vector<ToolContact> kept = std::move(contacts);
    kept.clear();
    *this = StepReport();
    contacts = std::move(kept);
  }
};

/// Scratch memory of a solver; carries nothing from one step to the next.
class SolverWorkspace {
 public:
  virtual ~SolverWorkspace() = default;

  ToolPoses tool;                ///< before Solver::advance() `start` is that of the step
  StageClock* stages = nullptr;  ///< measures the parts of the step; null: nothing is measured
  bool wants_impedance = true;   ///< false: StepReport::tool_impedance stays empty, State::impedance as it is
};

/// Advances the tissue by one step under everything that acts on it: its own elasticity, gas, weight, foundation, the
/// moving tool and what the helix holds. Constant; all memory is in State and SolverWorkspace, so one solver serves
/// many states. The method may be explicit, position-based or implicit, and may divide the step.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual std::string name() const = 0;  ///< one word for the method: "implicit", "xpbd"
  /// Divides the step into model.substeps explicit ones.
  virtual bool usesSubsteps() const { return false; }
  /// Memory for any states of a model, for one thread of control. The model must outlive it.
  virtual std::unique_ptr<SolverWorkspace> makeWorkspace(const Model& model) const = 0;

  /// @param motion  path of the tool during the step; null without a scope
  /// Changes positions, velocities, orientations, gas and energy account of the state; not its clock, joints or grip.
  virtual void advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                       SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const = 0;

  /// What a first step from this state takes long to make. As long as the result lives, other workspaces of the model
  /// need not make it. Null: there is no such thing. Changes no result.
  virtual std::shared_ptr<const void> prepare(const State& /*state*/, SolverWorkspace& /*scratch*/) const {
    return nullptr;
  }
};

}  // namespace vibe
