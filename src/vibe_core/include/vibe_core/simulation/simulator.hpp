#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

class MarkingScratch;

/// Scratch memory, caches and threads for stepping one model. Results do not depend on what a workspace was used for
/// before. One thread of control at a time.
class Workspace {
 public:
  /// @param threads  used inside a step, 1 or more; the result does not depend on it
  explicit Workspace(const Model& model, int threads = 1);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  SolverWorkspace& solverWorkspace() { return *solver_workspace_; }  ///< made by the solver of the model
  /// Mechanical impedance of the tissue at the tool in the last step. Empty while nothing is touched, and with solvers
  /// that do not estimate it (shape matching).
  const std::optional<ToolImpedance>& toolImpedance() const { return report_.tool_impedance; }
  /// Results of the last step beside the state: all that a workspace keeps of it.
  StepReport& report() { return report_; }
  MarkingScratch* marking() { return marking_.get(); }  ///< null in a scene without marking or scope
  int threads() const { return pool_.threads(); }       ///< as many as the constructor was given
  /// From now on StepReport::stage_times says what a step spends its time on, with the implicit solver.
  void measureStages();
  /// From now on toolImpedance() stays empty and State::impedance as it is. All else has the same bits.
  void skipImpedance() { solver_workspace_->wants_impedance = false; }

  ThreadPool& threadPool() { return pool_; }  ///< in which the parts of a step run

 private:
  ThreadPool pool_;
  std::unique_ptr<SolverWorkspace> solver_workspace_;
  std::unique_ptr<MarkingScratch> marking_;
  StepReport report_;
  std::unique_ptr<StageClock> stages_;  // null: not measured
};

/// One step of model.scene.step_period: the whole simulator. Programs use class Simulation, which calls it. No globals,
/// no wall clock, no allocation beyond what `workspace` and `events` keep. The result depends on model, state and input
/// only, not on the thread count.
/// @param workspace  scratch memory, made once per thread of control by Workspace(model); carries nothing between steps
/// @param events     what happened is appended
void step(const Model& model, State& state, const StepInput& input, Workspace& workspace, std::vector<Event>& events);

/// The gas source of the scene, or the button, is on.
bool insufflatorIsOn(const Model& model, const StepInput& input);

/// XXH3 (Collet), 64 bit, over the list of the state's fields and the bits of all of them (state_fields.hpp): equal
/// hashes mean equal states of builds with the same fields. Not against forgery.
std::uint64_t hash(const State& state);

/// The same of an input and the number of the step that used it.
std::uint64_t hash(const StepInput& input, std::int64_t step);

/// The same of a text, such as a scene.
std::uint64_t hash(const std::string& text);

}  // namespace vibe
