#include "procedure/bleeding.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "common/random.hpp"
#include "procedure/emit_event.hpp"

namespace vibe {

namespace {

constexpr double kRounding = 1e-9;  // of sums of steps [s]

std::string beginText(const Bleeding& bleeding) {
  char text[160];
  std::snprintf(text, sizeof text, "Bite %d of set %d bleeds %s, %.2f ml per minute%s", bleeding.bite + 1,
                bleeding.suture + 1, bleeding.brisk ? "briskly" : "mildly", bleeding.rate * 60e6,
                bleeding.brisk ? "; complete and cinch the set." : ".");
  return text;
}

void stop(Bleeding& bleeding, const char* why, double time, std::vector<Event>& events) {
  bleeding.rate = 0;
  emitEvent(Event::Kind::BleedingStopped, time, bleeding.particle, bleeding.amount,
            std::string("A ") + (bleeding.brisk ? "brisk" : "mild") + " bleeding of set " +
                std::to_string(bleeding.suture + 1) + " stopped " + why + " after " + inMillilitres(bleeding.amount) +
                ".",
            events);
}

}  // namespace

void bleedFromBite(const Model& model, int suture, int bite, int particle, State& state, std::vector<Event>& events) {
  if (!model.scene.bleeding) return;
  const BleedingScene& scene = *model.scene.bleeding;
  const double draw = nextUniform(state.random);
  if (draw >= scene.brisk_probability + scene.mild_probability) return;
  Bleeding bleeding;
  bleeding.suture = suture;
  bleeding.bite = bite;
  bleeding.particle = particle;
  bleeding.brisk = draw < scene.brisk_probability;
  bleeding.begin = state.time;
  bleeding.rate = bleeding.brisk ? scene.brisk_rate : scene.mild_rate;
  emitEvent(bleeding.brisk ? Event::Kind::BleedingBrisk : Event::Kind::BleedingMild, state.time, particle,
            bleeding.rate, beginText(bleeding), events);
  state.procedure.bleedings.push_back(bleeding);
}

void updateBleedings(const Model& model, State& state, std::vector<Event>& events) {
  if (!model.scene.bleeding) return;
  const BleedingScene& scene = *model.scene.bleeding;
  for (Bleeding& bleeding : state.procedure.bleedings) {
    if (bleeding.rate <= 0) continue;
    const double lost = bleeding.rate * model.scene.step_period;
    bleeding.amount += lost;
    state.procedure.blood_lost += lost;
    const double age = state.time - bleeding.begin + kRounding;
    if (!bleeding.brisk && age >= scene.mild_duration) stop(bleeding, "by itself", state.time, events);
    if (!bleeding.brisk || bleeding.overdue || age < scene.brisk_time) continue;
    bleeding.overdue = true;
    emitEvent(Event::Kind::BleedingOverdue, state.time, bleeding.particle, bleeding.amount,
              "The brisk bleeding of set " + std::to_string(bleeding.suture + 1) + " was not stopped in time, " +
                  inMillilitres(bleeding.amount) + " so far; complete and cinch the set.",
              events);
  }
}

void stopBleedings(int suture, State& state, std::vector<Event>& events) {
  for (Bleeding& bleeding : state.procedure.bleedings)
    if (bleeding.suture == suture && bleeding.rate > 0) stop(bleeding, "under the cinch", state.time, events);
}

void forgetBite(int suture, int bite, ProcedureState& procedure) {
  for (Bleeding& bleeding : procedure.bleedings) {
    if (bleeding.suture != suture) continue;
    if (bleeding.bite == bite)
      bleeding.bite = -1;
    else if (bleeding.bite > bite)
      --bleeding.bite;
  }
}

}  // namespace vibe
