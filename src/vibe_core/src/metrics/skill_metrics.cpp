#include "vibe_core/metrics/skill_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "vibe_core/program/error.hpp"

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

namespace {

constexpr double kMarkPeriod = 0.1;  // of counting marks that grow [s]

// Grades only rise, so it changes whenever one of them does.
long sumOf(const std::vector<std::uint8_t>& grades) {
  return std::accumulate(grades.begin(), grades.end(), 0L);
}

}  // namespace

BleedingSkill measureBleeding(const ProcedureState& procedure) {
  BleedingSkill skill;
  for (const Bleeding& bleeding : procedure.bleedings) {
    ++(bleeding.brisk ? skill.brisk : skill.mild);
    skill.now += bleeding.rate > 0 ? 1 : 0;
    skill.overdue += bleeding.overdue ? 1 : 0;
  }
  skill.lost = procedure.blood_lost;
  return skill;
}

SkillInstruments::SkillInstruments(const Model& model)
    : spectrum(std::make_shared<SpectralArcLength>(MotionRecorder::kLongestMovement)),
      marks(std::make_shared<MarkCounter>(model.organ)) {
  try {
    ruler = std::make_shared<OrganRuler>(model.organ);
  } catch (const Error& error) {
    ruler_fault = error.what();
  }
}

SkillRecorder::SkillRecorder(const SkillInstruments& instruments, const Model& model, const State& start,
                             const Eigen::Vector3d& tip)
    : marks_(instruments.marks),
      phases_(instruments.spectrum),
      organ_(instruments.ruler, instruments.ruler_fault, start) {
  if (model.tool) phases_.start(tip, model.scene.step_period);
  metrics_.organ = organ_.measures();
  countMarks(start);
  readSutures(model, start.procedure);
}

void SkillRecorder::record(const Model& model, const State& state, const Eigen::Vector3d& tip,
                           const std::vector<Event>& events, const EventCounts& counts) {
  phases_.record(state.procedure.phase, tip, state.tool_force.norm(), model.scene.step_period);
  metrics_.phases = phases_.measures();
  organ_.record(model, state, events);
  metrics_.organ = organ_.measures();
  updateMarks(model, state);
  if (events.empty()) {
    updateSets(state.procedure.sutures, metrics_.sets);
  } else {
    readMistakes(counts);
    readSutures(model, state.procedure);
  }
  metrics_.bleeding.lost = state.procedure.blood_lost;
}

// Not by events: a mark that grows into another, or out of the working zone, is none.
void SkillRecorder::updateMarks(const Model& model, const State& state) {
  const bool due = ++steps_ >= std::lround(kMarkPeriod / model.scene.step_period);
  if (due && sumOf(state.procedure.grade) != counted_grades_) countMarks(state);
}

void SkillRecorder::countMarks(const State& state) {
  steps_ = 0;
  counted_grades_ = sumOf(state.procedure.grade);
  metrics_.marks = marks_->count(state.procedure.grade, state.x, state.y, state.z);
}

void SkillRecorder::readSutures(const Model& model, const ProcedureState& procedure) {
  metrics_.bites = measureBites(model.organ, procedure.sutures);
  measureSets(model.organ, model.scene.suture ? &*model.scene.suture : nullptr, procedure.sutures, metrics_.sets);
  metrics_.bleeding = measureBleeding(procedure);
}

void SkillRecorder::readMistakes(const EventCounts& counts) {
  metrics_.mistakes.missed_bites = counts.of(Event::Kind::BiteMissed);
  metrics_.mistakes.withdrawn_bites = counts.of(Event::Kind::BiteWithdrawn);
  metrics_.mistakes.slips = counts.of(Event::Kind::Slip);
  metrics_.mistakes.broken_threads = counts.of(Event::Kind::ThreadBroke);
  metrics_.mistakes.rejected = counts.of(Event::Kind::Rejected);
}

}  // namespace vibe
