#include "vibe_core/metrics/skill_organ.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

constexpr double kPeriod = 1;  // of measurements [s]

bool isAct(Event::Kind kind) {
  return kind == Event::Kind::Mark || kind == Event::Kind::Burn || kind == Event::Kind::DeepBurn ||
         kind == Event::Kind::Pierced;
}

bool isUntouched(const ProcedureState& procedure) {
  return procedure.sutures.empty() && !procedure.pierced &&
         std::all_of(procedure.grade.begin(), procedure.grade.end(), [](std::uint8_t grade) { return grade == 0; });
}

std::optional<double> shrunk(const OrganMeasures& before, const OrganMeasures& now,
                             std::optional<double> OrganMeasures::*which) {
  return reduction(before.*which, now.*which);
}

}  // namespace

const char* toString(OrganReference reference) {
  switch (reference) {
    case OrganReference::Rest:
      return "rest";
    case OrganReference::SetPoint:
      return "set point";
    case OrganReference::FirstAct:
      return "first act";
  }
  return "unknown";
}

OrganTracker::OrganTracker(std::shared_ptr<OrganRuler> ruler, std::string fault, const State& start)
    : ruler_(std::move(ruler)) {
  skill_.fault = std::move(fault);
  if (!ruler_) return;
  skill_.before = ruler_->measureRest();
  measure(start);
  waits_ = isUntouched(start.procedure);
  if (waits_ && start.pressure_reached) takeReference(OrganReference::SetPoint, start);
}

void OrganTracker::record(const Model& model, const State& state, const std::vector<Event>& events) {
  if (!ruler_) return;
  for (const Event& event : events) {
    if (!waits_) break;
    if (event.kind == Event::Kind::PressureReached) takeReference(OrganReference::SetPoint, state);
    if (isAct(event.kind) && waits_) takeReference(OrganReference::FirstAct, state);
  }
  if (++steps_ >= std::max(1L, std::lround(kPeriod / model.scene.step_period))) measure(state);
}

// A state that has lost its numbers leaves no value until it is led back.
void OrganTracker::measure(const State& state) {
  steps_ = 0;
  skill_.pressure = state.pressure;
  try {
    skill_.now = ruler_->measure(state.x, state.y, state.z);
  } catch (const Error&) {
    skill_.now.reset();
  }
  compare();
}

void OrganTracker::takeReference(OrganReference reference, const State& state) {
  measure(state);
  if (!skill_.now) return;
  waits_ = false;
  skill_.reference = reference;
  skill_.reference_pressure = state.pressure;
  skill_.before = skill_.now;
  compare();
}

void OrganTracker::compare() {
  skill_.area_reduction.reset();
  skill_.volume_reduction.reset();
  skill_.length_reduction.reset();
  if (!skill_.now || !skill_.before) return;
  skill_.area_reduction = shrunk(*skill_.before, *skill_.now, &OrganMeasures::mean_area);
  skill_.length_reduction = shrunk(*skill_.before, *skill_.now, &OrganMeasures::length);
  skill_.volume_reduction = reduction(skill_.before->volume, skill_.now->volume);
}

}  // namespace vibe
