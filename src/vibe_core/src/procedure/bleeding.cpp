#include "procedure/bleeding.hpp"

#include <cmath>
#include <cstdint>

#include "vibe_core/common/random.hpp"
#include "vibe_core/events/event_log.hpp"

namespace vibe {

namespace {

constexpr double kRounding = 1e-9;  // tolerance for the rounding of times that are sums of steps [s]

Event& emitBleeding(Event::Kind kind, const Bleeding& bleeding, double value, EventLog log) {
  Event& event = log.emit(kind, bleeding.particle, value);
  event.suture = bleeding.suture;
  event.bite = bleeding.bite;
  return event;
}

void stop(Bleeding& bleeding, EventDetail how, EventLog log) {
  bleeding.rate = 0;
  emitBleeding(Event::Kind::BleedingStopped, bleeding, bleeding.amount, log).detail = how;
}

}  // namespace

void bleedFromBite(const Model& model, int suture, int bite, int particle, State& state, EventLog log) {
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
  emitBleeding(bleeding.brisk ? Event::Kind::BleedingBrisk : Event::Kind::BleedingMild, bleeding, bleeding.rate, log);
  state.procedure.bleedings.push_back(bleeding);
}

void updateBleedings(const Model& model, State& state, EventLog log) {
  if (!model.scene.bleeding) return;
  const BleedingScene& scene = *model.scene.bleeding;
  for (Bleeding& bleeding : state.procedure.bleedings) {
    if (bleeding.rate <= 0) continue;
    const double lost = bleeding.rate * model.scene.step_period;
    bleeding.amount += lost;
    state.procedure.blood_lost += lost;
    const double age = state.time - bleeding.begin + kRounding;
    if (!bleeding.brisk && age >= scene.mild_duration) stop(bleeding, EventDetail::MildByItself, log);
    if (!bleeding.brisk || bleeding.overdue || age < scene.brisk_time) continue;
    bleeding.overdue = true;
    emitBleeding(Event::Kind::BleedingOverdue, bleeding, bleeding.amount, log);
  }
}

void stopBleedings(int suture, State& state, EventLog log) {
  for (Bleeding& bleeding : state.procedure.bleedings) {
    if (bleeding.suture != suture || bleeding.rate <= 0) continue;
    stop(bleeding, bleeding.brisk ? EventDetail::BriskCinched : EventDetail::MildCinched, log);
  }
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
