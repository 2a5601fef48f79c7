#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// The phase follows from the actions; no phase forbids a command:
//   Inspect  at the start, and when the scope is inserted again after Done
//   Mark     from the first use of the argon beam, except between T-tag and cinch
//   Suture   from the first grab of the helix or the first pierced wall; again when a set is finished
//   Pull     from the T-tag to the release of the cinch
//   Done     all sets are permanent, at least one is cinched, the arm is open, the helix holds nothing, and the scope
//   is
//            withdrawn to less than 1 cm

/// Enters a phase, with an Event::Kind::PhaseChanged unless it is the present one.
void enterPhase(Phase phase, State& state, EventLog log);

/// Call when the argon beam heats tissue.
void noteMarking(State& state, EventLog log);

/// Call when the helix has grabbed or the needle has pierced the wall.
void noteSuturing(State& state, EventLog log);

/// Enters Done, and Inspect after it, depending on the insertion of the scope.
void updatePhase(const Model& model, State& state, EventLog log);

/// Whether the gas is at the set point of the insufflator: from within 1 % of it (at least 1 Pa) until it is more than
/// 5 % (at least 5 Pa) away, so that pressure that is disturbed by the tool does not reach the set point again and
/// again. Design choice: a wall that is pushed or drawn in changes the pressure by less than 5 %.
/// @param pressure, set_point  gauge [Pa]
/// @param was                  the answer of the step before
bool isAtSetPoint(double pressure, double set_point, bool was);

// Without scene.bleeding, bleedFromBite() and updateBleedings() do nothing and draw no random number.

/// Decides at random whether a new bite bleeds, and starts the bleeding. There is exactly one draw per bite, so that
/// the outcome of a bite does not depend on the outcomes of earlier ones.
void bleedFromBite(const Model& model, int suture, int bite, int particle, State& state, EventLog log);

/// Advances all bleedings by one step: adds up the blood lost, stops mild ones after their duration, and reports brisk
/// ones that were not stopped in time.
void updateBleedings(const Model& model, State& state, EventLog log);

/// Stops the bleedings of a set, because the cinch presses its walls together.
void stopBleedings(int suture, State& state, EventLog log);

/// Call when a bite has torn out: renumbers the later bites of its set. Its bleeding continues until the set is
/// cinched.
void forgetBite(int suture, int bite, ProcedureState& procedure);

// The procedure as a deterministic state machine. Every pressed button and every closing of the needle arm either acts
// or emits one Event::Kind::Rejected with the reason. From every state a set can be finished.

/// Call before the tissue moves and after updateGrip(): applies the input to needle, exchange, T-tag and cinch, and
/// shortens the threads that are being drawn.
/// @param link_poses  of the tool's links in world at the start of the step
void commandProcedure(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const StepInput& input,
                      State& state, EventLog log);

/// Call after the tissue has moved: breaks overloaded threads, tears out overloaded bites, updates bleeding and phase.
void updateProcedure(const Model& model, State& state, EventLog log);

}  // namespace vibe
