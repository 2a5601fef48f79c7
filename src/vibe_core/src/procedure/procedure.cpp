#include "procedure/procedure.hpp"

#include <string>

#include "procedure/bleeding.hpp"
#include "procedure/cinch.hpp"
#include "procedure/emit_event.hpp"
#include "procedure/needle_arm.hpp"
#include "procedure/phase.hpp"
#include "procedure/thread_events.hpp"

namespace vibe {

namespace {

// The part of the scene that a button needs and the scene does not have; null: it has it.
const char* missingPart(const Model& model, int button) {
  const Scene& scene = model.scene;
  if (button == Insufflate) return scene.gas ? nullptr : "gas";
  if (!model.tool) return "scope";
  switch (button) {
    case ApcPedal:
      return scene.marking ? nullptr : "marking";
    case HelixGrab:
      return scene.helix ? nullptr : "helix";
    case Needle:
    case TTag:
    case Cinch:
      return scene.suture ? nullptr : "suture";
    default:
      return nullptr;
  }
}

void rejectWithoutPart(const Model& model, const StepInput& input, const State& state, std::vector<Event>& events) {
  for (int button = 0; button < kButtonCount; ++button) {
    if (input.buttons[button] == 0 || state.procedure.pressed[button] != 0) continue;
    const char* part = missingPart(model, button);
    if (!part) continue;
    reject(button, state.time,
           std::string("The button '") + kButtonNames[button] + "' does nothing, the scene has no section '" + part +
               "'; add `" + part + ":` to it.",
           events);
  }
}

}  // namespace

void commandProcedure(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const StepInput& input,
                      State& state, std::vector<Event>& events) {
  rejectWithoutPart(model, input, state, events);
  const std::array<std::uint8_t, kButtonCount> before = state.procedure.pressed;
  const auto wentDown = [&](Button button) { return input.buttons[button] != 0 && before[button] == 0; };
  // when several come in one step: marking, needle, T-tag, cinch, each finding what the one before it did
  if (model.scene.suture && model.tool) {
    updateArm(model, link_poses, state, events);
    if (wentDown(Needle)) exchangeNeedle(model, state, events);
    if (wentDown(TTag)) dropTTag(model, state, events);
    commandCinch(model, input.buttons[Cinch] != 0, before[Cinch] != 0, state, events);
  }
  for (int button = 0; button < kButtonCount; ++button)
    state.procedure.pressed[button] = input.buttons[button] != 0 ? 1 : 0;
}

void updateProcedure(const Model& model, State& state, std::vector<Event>& events) {
  if (!model.scene.suture || !model.tool) return;
  updateThreads(model, state, events);
  updateBleedings(model, state, events);
  updatePhase(model, state, events);
}

}  // namespace vibe
