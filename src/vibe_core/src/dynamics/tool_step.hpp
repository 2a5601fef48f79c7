#pragma once

#include <optional>

#include "dynamics/implicit_workspace.hpp"
#include "vibe_core/tool/scope_springs.hpp"

namespace vibe {

struct Model;

/// The tool during one implicit step: where it is expected to end, because a scope yields to the forces of the step;
/// where it ends in truth, and whether tissue stops it on its way; and what its forces are to the hand.
///
/// Contacts are looked for where the tool is expected at the end of the step, and the tool yields along the directions
/// in which it moves in the middle: its motion along the wall and the work of the forces are then right to second
/// order. Where the forces of the step lead it elsewhere, the step is tried again with a better aim.
class ToolStep {
 public:
  /// @param motion  of the tool as the hand moves it; must outlive this
  ToolStep(const Model& model, const ToolMotion& motion, State& state, ImplicitWorkspace& scratch, StepReport& report);

  /// Whether the hand has held all joints still for a while, see HoldMemory.
  bool holds() const;
  /// Before the blocks prepare their loads: poses at the end, and the springs of a tool that yields.
  void addSprings();
  /// Of a tool that yields, in the middle of the step; null: it is rigid.
  const ShaftBend* bend() const { return !limited_ && bend_ ? &*bend_ : nullptr; }
  /// Whether the forces of the step bring the tool elsewhere than where its contacts were looked for. That is so while
  /// a tip is pushed aside ever faster: the pull of the last step lags behind.
  bool misses() const;
  /// Expects the tool farther on the way to where the forces have led it.
  /// @param follow  over that way
  void reaim(double follow);
  /// After a solve: from here on the tool is where the forces of the step have brought it.
  void yield();

  /// Whether tissue stops the tool, for the first time in the step.
  bool isStopped();
  /// The next solve has the tool where it can go.
  void limit();
  /// After the last solve: the tool goes as far as the wall lets it.
  /// @returns the part of their paths that the nodes may go without running into it
  double separate();
  /// The tool goes as far as a wall that stands still lets it; then nodes that would run into it wait.
  void recoverAround();

  /// Forces of the tissue on the tool, what the hand bears, and the impedance, from the touches of the step.
  void report(const ImplicitStepper& stepper);

 private:
  ToolDisplacement expectedDisplacement() const;
  bool isOverloaded() const;
  void reportStopped(const ToolMotion& wanted);
  void reportForces();
  void reportLoad();
  void reportHand(double tool_work);
  void reportImpedance(const ImplicitStepper& stepper);

  const Model& model_;
  const ToolMotion* motion_;  // that the next solve has; `limited_` once the tool is stopped
  State& state_;
  ImplicitWorkspace& scratch_;
  StepReport& report_;
  double step_;  // [s]
  bool still_;   // the hand moves no joint in this step
  std::optional<ShaftBend> bend_;
  std::optional<ScopeSpringStep> springs_;
  ToolDisplacement expected_{};        // at the end of the step
  bool aimed_again_ = false;           // `expected_` is that of reaim()
  std::optional<ToolMotion> yielded_;  // its motion, after the solve
  std::optional<ToolMotion> limited_;  // to where it can go; empty: it goes where the solve has it
};

}  // namespace vibe
