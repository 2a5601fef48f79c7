#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/tool/tool_model.hpp"
#include "vibe_core/tool_contact/tool_contact.hpp"

namespace vibe {

class EnergyTerm;
class ShaftBend;
class ThreadPool;
struct Model;
struct State;

/// One step, as constraint blocks see it.
struct StepContext {
  const Model& model;     ///< of the state; constant
  State& state;           ///< before the solve: at the start of the step; after it: at its end
  double step;            ///< duration [s]
  const ToolPoses* tool;  ///< null without a tool. A tool that yields: before the solve as if it did not in this step
  bool insufflator_on;    ///< for the gas
  const ShaftBend* bend = nullptr;  ///< of a tool that yields, at the poses tool->middle; null: it is rigid
  double when = 1;                  ///< part of the step after which its forces act
  ThreadPool* pool = nullptr;       ///< for what a block does in pieces; null: the calling thread only
};

/// What a block means for tissue at rest. A step is skipped while all blocks of a resting tissue agree to `Sleep`.
enum class Activity {
  Sleep,   ///< nothing that resting tissue does not balance already
  Wake,    ///< the loads change: the step is computed, and tissue that stays at rest in it still counts as resting
  Disturb  ///< something outside acts: the tissue does not count as resting
};

/// A force between tool and tissue as a block hands it over: what StepReport::contacts keeps of it, and what the step
/// needs beside that for its account and for the impedance of the tool.
struct ToolTouch : ToolContact {
  /// Takes the place of `surface` where it is more than a point: the weighted mean of these particles. Owned by the
  /// block, as it is until its next prepare(); null: none.
  const AttachmentPoint* patch = nullptr;
  double compliance = 0;   ///< between the tool and the point [m/N]
  Eigen::Vector3d motion;  ///< of the tool at this point during the step [m]
  Eigen::Vector3d middle;  ///< where that point of the tool is half way, world [m]
  double work = 0;         ///< of the force on the tissue, which is -force, over the step [J]
  /// Unit directions in which the point follows the tool, the first direction_count of them: all three where it sticks,
  /// the normal where it slides. The impedance of the tool is computed from them.
  std::array<Eigen::Vector3d, 3> direction;
  int direction_count = 0;  ///< of the entries of `direction` that count, 0 to 3
};

/// A load on the particles of a solver that divides the step. Positions move as by an XPBD constraint: what is imposed
/// on a particle is an impulse, so its velocity changes by the displacement over the duration of the sub-step.
class SubstepLoad {
 public:
  virtual ~SubstepLoad() = default;
  /// At the start of a step.
  virtual void prepareSubsteps(const Model& model, State& state) = 0;
  /// In every sub-step, before the grip and contacts. @param substep  duration [s]
  virtual void apply(const Model& model, double substep, State& state) = 0;
  /// At the end of the step: forces to the state, work to State::energy. @param count  of sub-steps
  virtual void reportSubsteps(int count, State& state) = 0;
};

/// One kind of load or constraint on the tissue, for example the grip or the threads. The implicit step asks its blocks
/// in the order of registration, see constraint_registry.hpp, and knows no kinds; what the helix holds and whether the
/// gas bears the wall's tension it reads from State. All functions run on the thread that steps; none allocates once
/// the block's buffers have grown.
///
/// A block belongs to the scratch memory of one simulation. It must not carry anything from one step to the next that
/// results depend on: what has to last is in State.
///
/// In every step: prepare(). If the tissue is awake: begin(). Then either recover(), or energyTerm(), the solve,
/// correct() and store().
class ConstraintBlock {
 public:
  virtual ~ConstraintBlock() = default;

  /// Adds this step's constraints, contacts and threads to the loads. Must not change the state: the step may be
  /// skipped.
  virtual Activity prepare(const StepContext& context, BodyLoads& loads) = 0;

  /// The step is computed: changes of the state that come before the solve.
  virtual void begin(const StepContext& /*context*/, BodyLoads& /*loads*/) {}

  /// A potential energy that acts in this step; null: none. It must live until the end of the step.
  virtual const EnergyTerm* energyTerm(const StepContext& /*context*/) { return nullptr; }

  /// After the solve: moves nodes to where they may be. Runs for all blocks before any store().
  virtual void correct(const StepContext& /*context*/) {}

  /// After the solve: reads forces from the loads, stores what has to last in the state, adds its work to
  /// State::energy (loads from outside to pull_work) and its forces between tool and tissue to `touches`.
  /// @returns the work of its energyTerm() on the tissue that it has added to State::energy; what it has not counts as
  ///          done by walls in contact. 0 without a term [J]
  virtual double store(const StepContext& /*context*/, const BodyLoads& /*loads*/,
                       std::vector<ToolTouch>& /*touches*/) {
    return 0;
  }

  /// In place of the solve, while tissue that was lost is led back to rest: the nodes have been moved already, and the
  /// block gives up its forces and whatever would pull the tissue away again.
  virtual void recover(const StepContext& /*context*/) {}

  /// The same load for solvers that divide the step, which ask for nothing else; null: it needs the implicit step.
  virtual SubstepLoad* substepLoad() { return nullptr; }
};

/// Makes the block of a model, or returns null where its scene does not need it.
using ConstraintFactory = std::function<std::unique_ptr<ConstraintBlock>(const Model&)>;

/// Adds a kind of constraint after those that exist. Simulations whose scratch memory (Workspace) is made from then on
/// have it. Solvers that divide the step use its substepLoad(); they reject a model for which the factory makes a block
/// without one.
/// Call it before simulations run, for example at the beginning of main(); any thread may call it.
/// @throws vibe::Error if the name is registered already
void registerConstraint(const std::string& name, ConstraintFactory factory);

/// Removes a kind added by registerConstraint(). Simulations that exist keep their block.
/// @throws vibe::Error if no such kind was added
void unregisterConstraint(const std::string& name);

/// Names of all kinds, in the order in which blocks are asked: those of the library, then those that were added.
std::vector<std::string> constraintNames();

/// The blocks of a model, in the order of constraintNames().
std::vector<std::unique_ptr<ConstraintBlock>> makeConstraintBlocks(const Model& model);

/// The blocks of the added kinds, for solvers that divide the step.
/// @throws vibe::Error if one of them has no substepLoad()
std::vector<std::unique_ptr<ConstraintBlock>> makeSubstepBlocks(const Model& model);

}  // namespace vibe
