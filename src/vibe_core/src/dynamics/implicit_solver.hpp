#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptics/impedance_estimator.hpp"
#include "solver/sum_term.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/tool_guard.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// What tells a state that has no way back from one that its loads hold. Judged by the law of the wall itself.
///
/// A wall that swells uniformly by a stretch s bears the pressure p(s) = dW/ds / (3 s^2 V), W its elastic energy and V
/// its volume at rest. Laws that stiffen little have a greatest p, the limit pressure (a neo-Hookean sphere at
/// s = 1.38; Beatty 1987, doi 10.1115/1.3149545, section 6). Beyond it an insufflator finds no equilibrium: the wall
/// bursts. Walls that stiffen enough have no such limit and are left alone at any stretch.
class LossLimits {
 public:
  /// @param rest  positions at rest [m]
  LossLimits(const ShellElements& shell, const std::vector<Eigen::Vector3d>& rest);

  /// Elastic energy that only gas can store in a wall: a tenth of what makes the whole organ twice as large [J].
  double unheldEnergy() const { return unheld_energy_; }
  /// Whether the wall bursts.
  /// @param volume    of the lumen [m^3]
  /// @param pressure  gauge, of the gas [Pa]
  /// @param filling   an insufflator works
  bool bursts(double volume, double pressure, bool filling) const;
  /// Greatest pressure that the swelling wall bears; infinite without one [Pa].
  double limitPressure() const { return limit_pressure_; }
  /// The stretch there; infinite without one [1].
  double limitStretch() const { return limit_stretch_; }

 private:
  double rest_volume_ = 0;
  double unheld_energy_ = 0;
  double limit_stretch_, limit_pressure_;
  std::vector<double> pressure_;  // borne at kFirst + k * kSpacing
};

/// Buffers of ImplicitSolver.
struct ImplicitWorkspace : SolverWorkspace {
  std::shared_ptr<StepperWorkspace> stepper;
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;  // in the order in which they are asked
  BodyLoads loads;
  SumTerm terms;                                   // energies of the blocks
  std::array<std::vector<double>, 6> uncorrected;  // positions and velocities before corrections [m], [m/s]
  std::optional<ToolGuard> guard;                  // empty without a tool
  std::vector<int> held;                           // particles that the helix holds
  std::array<std::vector<double>, 9> start;        // positions, velocities, accelerations before it [m], [s]
  std::vector<ToolTouch> touches;                  // of the last step
  std::unique_ptr<ImpedanceEstimator> impedance;   // null without a tool
  ToolContactRows tool_rows;
};

/// The touches of the last step as rows for the tool's impedance, with the motion of their targets per motion of the
/// tool: from scratch.touches to scratch.tool_rows.
void findToolContactRows(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper,
                         const StepReport& report, ImplicitWorkspace& scratch);

/// Positions, velocities, accelerations of the nodes.
constexpr std::size_t kMotion = 9;
constexpr std::array<std::vector<double> State::*, kMotion> kMotionOf{
    &State::x, &State::y, &State::z, &State::vx, &State::vy, &State::vz, &State::ax, &State::ay, &State::az};

/// One step of a scene: the constraint blocks add their loads, the stepper moves the tissue, the blocks store their
/// forces. Resting tissue is skipped; lost tissue is led back to rest.
class ImplicitStep {
 public:
  /// @param limits  that tell a lost state
  ImplicitStep(const Model& model, const ImplicitStepper& stepper, const LossLimits& limits, const ToolMotion* motion,
               bool insufflator_on, State& state, ImplicitWorkspace& scratch, StepReport& report);
  void run();

 private:
  Activity gather();
  void begin();
  void gatherSprings();
  ToolDisplacement expectedDisplacement() const;
  bool asleep(Activity activity) const;
  bool lost() const;
  bool jammed() const;
  void noteJam(double given, double held);
  bool heldByGas() const;
  void recover();
  void recoverAround();
  SurfacePath pathOfStep() const;
  bool solve();
  StepOutcome advance();
  void note(const StepOutcome& outcome);
  void yieldTool();
  bool missesTool() const;
  void expectAgain();
  void startAgain();
  bool keepApart();
  bool isCorrected() const;
  bool stopsTool();
  void keepToolApart();
  void noteStopped(const ToolMotion& wanted);
  void stopWall(double part);
  void giveWay();
  void store();
  void reportTool();
  void reportHand(double tool_work);
  void reportImpedance();
  void correct();
  void account();
  Energies mechanicalEnergy() const;
  void updateRest(Activity activity);
  MotionView motionOf() const;

  const Model& model_;
  const ImplicitStepper& stepper_;
  const LossLimits& limits_;
  const ToolMotion* motion_;
  State& state_;
  StepReport& report_;
  ImplicitWorkspace& scratch_;
  std::optional<ShaftBend> bend_;           // of a tool that yields, in the middle of the step
  std::optional<ScopeSpringStep> springs_;  // of it
  ToolDisplacement expected_{};             // of it at the end of the step
  bool expected_again_ = false;             // after a first solve
  bool refused_ = false;                    // the last solve, before anything has moved
  std::optional<ToolMotion> yielded_;       // its motion, after the solve
  std::optional<ToolMotion> limited_;       // to where it can go; empty: it goes where the solve has it
  StepContext context_;
  bool tool_stopped_ = false;  // by tissue, on its way
  StepWork work_;              // of the solve
  double contact_energy_ = 0;  // before it [J]
};

class ShellElements;

/// Advances the tissue of a scene by implicit steps: one step of ImplicitStepper per step of the simulator. What acts
/// on the tissue comes from constraint blocks, see constraint_registry.hpp.
class ImplicitSolver : public Solver {
 public:
  /// @param shell  the wall, on the particles
  ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings);

  std::string name() const override { return "implicit"; }
  std::unique_ptr<SolverWorkspace> makeWorkspace(const Model& model) const override;
  void advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
               SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const override;
  std::shared_ptr<const void> prepare(const State& state, SolverWorkspace& scratch) const override;

 private:
  std::shared_ptr<const ShellElements> shell_;
  ImplicitStepper stepper_;
  LossLimits limits_;
  mutable std::once_flag rest_asked_;
  mutable std::unique_ptr<const RestStiffness> rest_;  // of all workspaces; made with the first one

  const RestStiffness& restStiffness() const;
};

}  // namespace vibe
