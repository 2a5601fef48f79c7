#include "procedure/marking.hpp"

#include <algorithm>

#include "procedure/procedure.hpp"
#include "vibe_core/events/event.hpp"

namespace vibe {

namespace {

Event::Kind kindOf(BurnGrade grade) {
  if (grade == BurnGrade::Deep) return Event::Kind::DeepBurn;
  return grade == BurnGrade::Burn ? Event::Kind::Burn : Event::Kind::Mark;
}

void emitBurn(const Burn& burn, double dose, std::size_t marks, EventLog log) {
  Event& event = log.emit(kindOf(burn.grade), burn.particle, dose);
  event.region = burn.region;
  event.wall = burn.wall;
  if (event.kind != Event::Kind::Mark) return;
  event.detail = inWorkingZone(burn.region, burn.wall) ? EventDetail::InZone : EventDetail::OutOfZone;
  event.amount = static_cast<double>(marks);
}

bool beginsThere(const Burn& burn, const std::vector<int>& neighbours, const std::vector<std::uint8_t>& grade) {
  return std::none_of(neighbours.begin(), neighbours.end(),
                      [&](int next) { return grade[next] >= static_cast<std::uint8_t>(burn.grade); });
}

void fireBeam(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool went_down, State& state,
              MarkingScratch& scratch, EventLog log) {
  const ApcParameters& apc = model.scene.marking->apc;
  const Eigen::Isometry3d& tip = link_poses[model.tip_link];
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  const BeamHit& hit = scratch.beam.fire(tip.translation(), tip.linear().col(0), wall, model.particle_radius, apc);
  if (hit.triangle >= 0) return noteMarking(state, log);
  if (went_down) log.reject(ApcPedal, RejectReason::BeamOutOfReach).limit = apc.probe_length + apc.reach;
}

void recordBurns(const Model& model, State& state, MarkingScratch& scratch, EventLog log) {
  ProcedureState& procedure = state.procedure;
  for (const Burn& burn : scratch.burns) {
    const bool begins = beginsThere(burn, scratch.neighbours[burn.particle], procedure.grade);
    procedure.grade[burn.particle] = static_cast<std::uint8_t>(burn.grade);
    if (!begins) continue;
    const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
    const std::size_t marks = scratch.finder.find(*model.dose_law, procedure.dose, wall).size();
    emitBurn(burn, procedure.dose[burn.particle], marks, log);
  }
}

}  // namespace

MarkingScratch::MarkingScratch(const Model& model)
    : beam(model.organ.surface),
      finder(model.organ),
      neighbours(vertexNeighbours(model.organ.surface)),
      deformation(makeMarkingDeformation(model)) {
  burns.reserve(neighbours.size());
}

void updateMarking(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const BeamStep& step,
                   State& state, MarkingScratch& scratch, EventLog log) {
  const double dt = model.scene.step_period;
  if (step.pedal) fireBeam(model, link_poses, step.went_down, state, scratch, log);
  const std::vector<BeamShare>& shares = step.pedal ? scratch.beam.shares() : scratch.no_beam;
  for (const BeamShare& share : shares) state.procedure.beam_energy += share.power * dt;
  const GasFlow flow{step.pedal ? model.scene.marking->apc.argon_flow : 0, step.insufflation};
  scratch.burns.clear();
  model.dose_law->advance(model.organ, shares, flow, dt, state.procedure.heat, state.procedure.dose, scratch.burns);
  recordBurns(model, state, scratch, log);
}

void coolDown(State& state) {
  ProcedureState& procedure = state.procedure;
  std::fill(procedure.heat.begin(), procedure.heat.end(), 0.f);
  for (auto* base : {&procedure.base_x, &procedure.base_y, &procedure.base_z}) base->clear();
}

}  // namespace vibe
