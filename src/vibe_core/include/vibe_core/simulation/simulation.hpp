#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/constraints/wall_contacts.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/metrics/session_metrics.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/simulation/stage_summary.hpp"
#include "vibe_core/simulation/thread_contacts.hpp"
#include "vibe_core/simulation/wall_coverage.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Scene file -> Model: loadScene(), the URDF that the scene names, buildModel().
/// @param address  path or package://PACKAGE/path
/// @throws Error
std::shared_ptr<const Model> loadModel(const std::string& address, const Progress& progress = {});

struct SimulationSettings {
  std::optional<std::uint64_t> seed;  ///< of the first state; empty: that of the scene
  int threads = 1;                    ///< used inside a step, 1 or more; results do not depend on it
  bool metrics = true;                ///< false: metrics() stays empty; for studies that have no use for them
  bool impedance = true;              ///< false: toolImpedance() stays empty, and State::impedance as it is
  bool stages = false;                ///< true: stages() says what steps spend their time on

  /// One thread, no metrics.
  static SimulationSettings study(std::uint64_t seed) {
    SimulationSettings settings;
    settings.seed = seed;
    settings.metrics = false;
    return settings;
  }
};

/// A running simulation, and the entry point of the library:
///
///   vibe::Simulation simulation(vibe::loadModel("package://vibe_core/scenes/stomach.yaml"));
///   vibe::StepInput input;
///   input.joints[vibe::Insertion] = 0.1;                        // [m]
///   for (int i = 0; i < 600; ++i) simulation.step(input);       // ten seconds
///   double volume = simulation.state().volume;                  // [m^3]
///
/// It owns a Model, which is constant and may be shared, a State, which is everything that changes, and the scratch
/// memory of a step; and it keeps what a session reports: the events of the last step, metrics and step times. The
/// physics is the free function vibe::step() (simulator.hpp), which this class calls and nothing else does.
///
/// Determinism: model, state and inputs determine all that follows to the bit. A copy of state(), a snapshot, or the
/// same inputs again therefore have the same future, whatever the number of threads. Metrics, events and times are
/// results only; replacing the state starts metrics and events anew.
///
/// Units are SI, the frame is the world (x to the patient's front, y to the left, z to the head). A step does not throw
/// because of values in the state, and a settled step allocates no memory. Not thread-safe: one thread at a time.
class Simulation {
 public:
  /// Input of the step that begins at a time [s] of state().time.
  using InputSource = std::function<StepInput(double time)>;
  /// Called after each step.
  using Observer = std::function<void(const Simulation&)>;

  /// Begins at the initial state: rest shape, scope at the lower end of its range.
  explicit Simulation(std::shared_ptr<const Model> model, const SimulationSettings& settings = {});

  // --- stepping

  /// One step of stepPeriod() with an input, which stays in force.
  /// @return what happened, as events()
  const std::vector<Event>& step(const StepInput& input);
  /// One step with the input in force.
  const std::vector<Event>& step();
  /// Steps with inputs from a source, such as a TraineeScript, until `steps` are taken.
  void run(std::int64_t steps, const InputSource& source, const Observer& observer = {});

  /// Takes one step with a copy of the state and forgets it: the first step analyses the equations, which takes ten
  /// times as long as a step, so that a simulation in real time does it before time begins. Changes no result.
  void warmUp();

  /// The input in force. Initially, and after the state was replaced, one under which the state stays as it is: joints
  /// where they are, what is held stays held.
  const StepInput& input() const { return input_; }
  void setInput(const StepInput& input) { input_ = input; }  ///< for the steps from now on

  // --- what there is

  const Model& model() const { return *model_; }  ///< as constructed, or of the last replaceModel()
  const std::shared_ptr<const Model>& sharedModel() const { return model_; }  ///< the same, to keep or to share it
  const State& state() const { return state_; }           ///< at the end of the last step, until the next changes it
  double time() const { return state_.time; }             ///< [s]
  std::int64_t stepCount() const { return state_.step; }  ///< since the initial state, through snapshots
  double stepPeriod() const { return model_->scene.step_period; }  ///< [s]
  // of the last step: all empty before the first one, and after the state was replaced
  /// What happened.
  const std::vector<Event>& events() const { return events_; }
  /// Impedance of the tissue at the tool; empty while nothing is touched, and with shape matching.
  const std::optional<ToolImpedance>& toolImpedance() const { return workspace_->toolImpedance(); }
  /// Iterations, contacts and forces.
  const StepReport& report() const { return workspace_->report(); }
  /// Where the tool touches and holds the wall in the last step: the parts of the force on it.
  const std::vector<ToolContact>& contacts() const { return report().contacts; }
  /// Where the wall of the present state presses on itself. Looked for in every call, and costs nothing without one.
  /// @returns valid until the next call
  const std::vector<WallContact>& wallContacts();
  /// What the threads of the present state do to the wall, likewise.
  std::vector<ThreadContact> threadContacts() const { return vibe::threadContacts(state_); }
  /// Since the state was last replaced; zero without SimulationSettings::metrics.
  const SessionMetrics& metrics() const;
  /// What the lens has seen since then, looked for ten times a second; null without SimulationSettings::metrics, and in
  /// scenes without `inspection`.
  const WallCoverage* coverage() const { return coverage_.get(); }
  /// Counts warnings of the program about its inputs among those of the metrics.
  void addWarnings(int count);
  /// Durations of vibe::step(), without metrics, since the simulation was made. Windows are the caller's to clear.
  StepTimer& timer() { return timer_; }
  const StepTimer& timer() const { return timer_; }  ///< to read only
  /// What the steps have spent their time on; null without SimulationSettings::stages.
  const StageSummary* stages() const { return stages_.get(); }
  /// See vibe::hash().
  std::uint64_t hash() const;

  // --- another state, another model

  /// Back to the initial state.
  void reset(std::optional<std::uint64_t> seed = {});
  /// For a state that simulations of this model will go back to often: as long as the result lives, the first step
  /// after replaceState() with it takes as long as any other, where it would take ten times as long. Costs that itself,
  /// and the memory of a factor. Null: the solver has nothing to prepare.
  std::shared_ptr<const void> prepare();
  /// Another state of the same model takes over.
  void replaceState(State state);
  /// Another model takes over, at its initial state with its scene's seed.
  void replaceModel(std::shared_ptr<const Model> model);
  /// @throws Error if the file cannot be written
  void saveSnapshot(const std::string& file) const;
  /// @throws Error, as loadSnapshot() of snapshot.hpp; nothing has changed then
  void loadSnapshot(const std::string& file);

  /// For studies that put things into the state between steps (bites, drawn thread, prescribed positions), which no
  /// trainee can. Whoever does so keeps the state one that the model can have reached.
  State& editState() { return state_; }
  /// Counts the present state with these events in the metrics, as the end of a step does. For edited states.
  void record(const std::vector<Event>& events);

 private:
  std::shared_ptr<const Model> model_;
  SimulationSettings settings_;
  State state_;
  std::unique_ptr<Workspace> workspace_;
  std::optional<MetricsRecorder> recorder_;
  std::unique_ptr<WallCoverage> coverage_;  // null: nobody asks
  StepInput input_;
  std::vector<Event> events_;
  StepTimer timer_;
  std::unique_ptr<StageSummary> stages_;
  std::unique_ptr<WallContacts> walls_;  // null until somebody asks

  void forgetStep();
  void forgetSeen();
  std::unique_ptr<WallCoverage> coverageFor(const Model& model) const;
  static std::unique_ptr<Workspace> workspaceFor(const Model& model, const SimulationSettings& settings);
};

}  // namespace vibe
