#include "procedure/marking.hpp"

#include <algorithm>
#include <string>

#include "procedure/emit_event.hpp"
#include "procedure/marking_touch.hpp"
#include "procedure/phase.hpp"

namespace vibe {

namespace {

Event::Kind kindOf(BurnGrade grade) {
  if (grade == BurnGrade::Deep) return Event::Kind::DeepBurn;
  return grade == BurnGrade::Burn ? Event::Kind::Burn : Event::Kind::Mark;
}

std::string place(const Burn& burn) {
  return std::string("wall ") + toString(burn.wall) + ", region " + toString(burn.region);
}

std::string describe(const Burn& burn, int marks) {
  if (burn.grade == BurnGrade::Deep)
    return "The beam has stayed so long that the muscularis is at risk (" + place(burn) + "); go on elsewhere.";
  if (burn.grade == BurnGrade::Burn)
    return "The beam has stayed so long that a scar remains (" + place(burn) + "); a mark takes about a second.";
  const std::string outside = inWorkingZone(burn.region, burn.wall) ? "" : ", outside the working zone";
  return "A mark begins (" + place(burn) + outside + "), " + std::to_string(marks) +
         (marks == 1 ? " mark is there now." : " marks are there now.");
}

bool beginsThere(const Burn& burn, const std::vector<int>& neighbours, const std::vector<std::uint8_t>& grade) {
  return std::none_of(neighbours.begin(), neighbours.end(),
                      [&](int next) { return grade[next] >= static_cast<std::uint8_t>(burn.grade); });
}

void fireBeam(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool went_down, State& state,
              MarkingScratch& scratch, std::vector<Event>& events) {
  const ApcParameters& apc = model.scene.marking->apc;
  const Eigen::Isometry3d& tip = link_poses[model.tip_link];
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const BeamHit& hit = scratch.beam.fire(tip.translation(), tip.linear().col(0), wall, model.particle_radius, apc);
  if (hit.triangle >= 0) return noteMarking(state, events);
  if (went_down)
    reject(ApcPedal, state.time,
           "The argon beam meets no tissue within " + inMillimetres(apc.probe_length + apc.reach) +
               " in front of the scope: go nearer.",
           events);
}

void recordBurns(const Model& model, State& state, MarkingScratch& scratch, std::vector<Event>& events) {
  ProcedureState& procedure = state.procedure;
  for (const Burn& burn : scratch.burns) {
    const bool begins = beginsThere(burn, scratch.neighbours[burn.particle], procedure.grade);
    procedure.grade[burn.particle] = static_cast<std::uint8_t>(burn.grade);
    if (!begins) continue;
    const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
    const auto marks = scratch.finder.find(*model.dose_law, procedure.dose, wall).size();
    emitEvent(kindOf(burn.grade), state.time, burn.particle, procedure.dose[burn.particle],
              describe(burn, static_cast<int>(marks)), events);
  }
}

}  // namespace

MarkingScratch::MarkingScratch(const Model& model)
    : beam(model.organ.surface), finder(model.organ), neighbours(vertexNeighbours(model.organ.surface)) {
  burns.reserve(neighbours.size());
  if (model.scene.marking->deformation == "gradient") touch = std::make_unique<MarkingTouch>(model);
}

MarkingScratch::~MarkingScratch() = default;

void updateMarking(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const BeamStep& step,
                   State& state, MarkingScratch& scratch, std::vector<Event>& events) {
  const double dt = model.scene.step_period;
  if (step.pedal) fireBeam(model, link_poses, step.went_down, state, scratch, events);
  const std::vector<BeamShare>& shares = step.pedal ? scratch.beam.shares() : scratch.no_beam;
  for (const BeamShare& share : shares) state.procedure.beam_energy += share.power * dt;
  const GasFlow flow{step.pedal ? model.scene.marking->apc.argon_flow : 0, step.insufflation};
  scratch.burns.clear();
  model.dose_law->advance(model.organ, shares, flow, dt, state.procedure.heat, state.procedure.dose, scratch.burns);
  recordBurns(model, state, scratch, events);
}

void coolDown(State& state) {
  ProcedureState& procedure = state.procedure;
  std::fill(procedure.heat.begin(), procedure.heat.end(), 0.f);
  for (auto* base : {&procedure.base_x, &procedure.base_y, &procedure.base_z}) base->clear();
}

}  // namespace vibe
