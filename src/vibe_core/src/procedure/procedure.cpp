#include "procedure/procedure.hpp"

#include "procedure/bleeding.hpp"
#include "procedure/cinch.hpp"
#include "procedure/needle_arm.hpp"
#include "procedure/phase.hpp"
#include "procedure/thread_events.hpp"
#include "vibe_core/events/event_log.hpp"

namespace vibe {

namespace {

// None: the scene has the section that the button needs.
RejectReason missingSection(const Model& model, int button) {
  const Scene& scene = model.scene;
  if (button == Insufflate) return scene.gas ? RejectReason::None : RejectReason::NoGas;
  if (!model.tool) return RejectReason::NoScope;
  switch (button) {
    case ApcPedal:
      return scene.marking ? RejectReason::None : RejectReason::NoMarking;
    case HelixGrab:
      return scene.helix ? RejectReason::None : RejectReason::NoHelix;
    case Needle:
    case TTag:
    case Cinch:
      return scene.suture ? RejectReason::None : RejectReason::NoSuture;
    default:
      return RejectReason::None;
  }
}

void rejectWithoutSection(const Model& model, const StepInput& input, const State& state, EventLog log) {
  for (int button = 0; button < kButtonCount; ++button) {
    if (input.buttons[button] == 0 || state.procedure.pressed[button] != 0) continue;
    const RejectReason reason = missingSection(model, button);
    if (reason != RejectReason::None) log.reject(button, reason);
  }
}

}  // namespace

void commandProcedure(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const StepInput& input,
                      State& state, EventLog log) {
  rejectWithoutSection(model, input, state, log);
  const std::array<std::uint8_t, kButtonCount> before = state.procedure.pressed;
  const auto wentDown = [&](Button button) { return input.buttons[button] != 0 && before[button] == 0; };
  // several in one step act in the order needle, T-tag, cinch; each sees the effect of the one before
  if (model.scene.suture && model.tool) {
    updateArm(model, link_poses, state, log);
    if (wentDown(Needle)) exchangeNeedle(model, state, log);
    if (wentDown(TTag)) dropTTag(model, state, log);
    commandCinch(model, input.buttons[Cinch] != 0, before[Cinch] != 0, state, log);
  }
  for (int button = 0; button < kButtonCount; ++button)
    state.procedure.pressed[button] = input.buttons[button] != 0 ? 1 : 0;
}

void updateProcedure(const Model& model, State& state, EventLog log) {
  if (!model.scene.suture || !model.tool) return;
  updateThreads(model, state, log);
  updateBleedings(model, state, log);
  updatePhase(model, state, log);
}

}  // namespace vibe
