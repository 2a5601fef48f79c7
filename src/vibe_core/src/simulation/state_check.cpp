#include "simulation/state_check.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/suture/technique.hpp"

namespace vibe {
namespace {

bool allFinite(const std::vector<double>& values) {
  for (double value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

std::string biteDamage(const Bite& bite, int particle_count) {
  if (bite.weight.size() != bite.particle.size()) return "a bite has not one weight per particle";
  for (int particle : bite.particle)
    if (particle < 0 || particle >= particle_count) return "a bite holds a particle that does not exist";
  if (!allFinite(bite.weight)) return "a bite's weight is not a number";
  if (static_cast<int>(bite.region) >= kRegionCount) return "a bite lies in a region that does not exist";
  if (bite.wall > Wall::LesserCurvature) return "a bite lies on a wall that does not exist";
  return "";
}

std::string groupDamage(const TissueGroup& group, int particle_count) {
  if (group.offset.size() != group.particle.size()) return "a group of a suture has not one place per particle";
  if (group.weight.size() != group.middle.size() || (group.middle.empty() && !group.empty()))
    return "a group of a suture has no middle";
  for (const std::vector<int>* list : {&group.particle, &group.middle})
    for (int particle : *list)
      if (particle < 0 || particle >= particle_count) return "a group of a suture holds a particle that does not exist";
  for (const Eigen::Vector3d& offset : group.offset)
    if (!offset.allFinite()) return "a place in a group of a suture is not a number";
  if (!allFinite(group.weight) || !(group.drawn >= 0 && group.drawn <= 1))
    return "a group of a suture is drawn to no place";
  return "";
}

std::string sutureDamage(const Suture& suture, int particle_count) {
  if (suture.stage > Suture::Stage::Broken) return "a suture's stage does not exist";
  if (std::max({suture.technique, suture.corrected_technique, suture.printed_technique}) >= kTechniqueCount)
    return "a suture's technique does not exist";
  if (suture.length.size() != suture.tension.size() || suture.length.size() > suture.bites.size())
    return "a suture's thread does not fit its bites";
  if (suture.pulls() && suture.length.size() + 1 != suture.bites.size())
    return "a suture that pulls has not one piece of thread from bite to bite";
  if (!allFinite(suture.length) || !allFinite(suture.tension)) return "a suture's thread is not a number long or taut";
  for (const Bite& bite : suture.bites) {
    const std::string damage = biteDamage(bite, particle_count);
    if (!damage.empty()) return damage;
    if (bite.particle.empty()) return "a bite of a suture holds nothing";
  }
  return groupDamage(suture.group, particle_count);
}

std::string bleedingDamage(const Bleeding& bleeding, const ProcedureState& procedure, int particle_count) {
  if (bleeding.particle < -1 || bleeding.particle >= particle_count) return "a particle bleeds that does not exist";
  if (bleeding.suture < -1 || bleeding.suture >= static_cast<int>(procedure.sutures.size()))
    return "a bite of a suture bleeds that does not exist";
  return "";
}

std::string procedureDamage(const ProcedureState& procedure, int particle_count) {
  if (procedure.phase > Phase::Done) return "its phase does not exist";
  const std::size_t doses = procedure.dose.size();
  const bool fits = doses == 0 || doses == static_cast<std::size_t>(particle_count);
  if (!fits || procedure.heat.size() != doses || procedure.grade.size() != doses)
    return "its marks are those of another organ";
  const std::size_t bases = procedure.base_x.size();
  const bool fitting = bases == 0 || bases == static_cast<std::size_t>(particle_count);
  if (!fitting || procedure.base_y.size() != bases || procedure.base_z.size() != bases)
    return "its wall before marking is that of another organ";
  if (!allFinite(procedure.base_x) || !allFinite(procedure.base_y) || !allFinite(procedure.base_z))
    return "its wall before marking is not a number";
  std::string damage = biteDamage(procedure.pending, particle_count);
  for (const Suture& suture : procedure.sutures)
    if (damage.empty()) damage = sutureDamage(suture, particle_count);
  for (const Bleeding& bleeding : procedure.bleedings)
    if (damage.empty()) damage = bleedingDamage(bleeding, procedure, particle_count);
  return damage;
}

std::string pullDamage(const PullSpring& pull, int particle_count) {
  if (pull.weight.size() != pull.node.size()) return "the pull spring has not one weight per particle";
  if (pull.particle < -1 || pull.particle >= particle_count || pull.holds() != (pull.particle >= 0))
    return "the pull spring holds a particle that does not exist";
  for (int node : pull.node)
    if (node < 0 || node >= particle_count) return "the pull spring holds a particle that does not exist";
  if (!allFinite(pull.weight) || !pull.target.allFinite() || !pull.force.allFinite()) return "the pull is not a number";
  return "";
}

std::string particleDamage(const State& s, std::size_t particle_count) {
  for (const auto* list :
       {&s.x, &s.y, &s.z, &s.vx, &s.vy, &s.vz, &s.ax, &s.ay, &s.az, &s.qw, &s.qx, &s.qy, &s.qz, &s.wx, &s.wy, &s.wz})
    if (list->size() != particle_count) return "it has another number of particles than its organ";
  if (s.grip.size() > particle_count) return "it holds more tissue than there is";
  for (const GripPoint& point : s.grip) {
    if (point.particle < 0 || static_cast<std::size_t>(point.particle) >= particle_count)
      return "it holds a particle that does not exist";
    if (!(point.weight > 0) || !std::isfinite(point.weight)) return "it holds a particle without a weight";
  }
  return "";
}

std::string toolDamage(const State& s, const Model& model) {
  double sum = 0;
  bool displaced = false;
  for (double value : s.joints) sum += value;
  for (double value : s.hand_effort) sum += value;
  for (double value : s.tool_load) sum += value;
  for (double value : s.tool_displacement) {
    sum += value;
    displaced = displaced || value != 0;
  }
  if (!std::isfinite(sum)) return "a joint of its tool is not a number";
  return displaced && !model.scope_springs ? "its tool gives way, which a rigid one does not" : "";
}

bool isEmptyOr(std::size_t size, std::size_t particle_count, std::size_t per_particle) {
  return size == 0 || size == per_particle * particle_count;
}

std::string basisDamage(const ImpedanceBasis& basis, std::size_t particle_count) {
  if (!isEmptyOr(basis.positions.size(), particle_count, 3) ||
      !isEmptyOr(basis.gas_direction.size(), particle_count, 4))
    return "its tool impedance remembers another organ";
  if (basis.gas_stiffness != 0 && basis.gas_direction.empty()) return "its tool impedance has gas without a direction";
  if (basis.direction.size() != basis.node.size() || basis.row_motion.size() != basis.node.size())
    return "its tool impedance has not one direction per row";
  for (int node : basis.node)
    if (node < 0 || static_cast<std::size_t>(node) >= particle_count)
      return "its tool impedance remembers a particle that does not exist";
  return "";
}

std::string solverDamage(const State& s, std::size_t particle_count) {
  for (const std::vector<float>* point : {&s.solver.linearization_point, &s.solver.next})
    if (!isEmptyOr(point->size(), particle_count, 3) && point->size() != 4 * particle_count)
      return "its solver remembers another organ";
  const std::string damage = basisDamage(s.impedance.current, particle_count);
  return damage.empty() ? basisDamage(s.impedance.next, particle_count) : damage;
}

bool hasNumbers(const KeptContact& contact) {
  const auto isNumber = [](double weight) { return std::isfinite(weight); };
  return std::all_of(contact.weight.begin(), contact.weight.end(), isNumber) && std::isfinite(contact.clearance) &&
         contact.force.allFinite() && contact.place.allFinite() && contact.normal.allFinite() &&
         contact.tool_point.allFinite();
}

std::string holdDamage(const State& state, const Model& model) {
  const int shapes = model.tool ? static_cast<int>(model.tool->shapes().size()) : 0;
  if (state.hold.steps < 0 || state.hold.steps > state.step) return "its tool is held for longer than it is there";
  for (const KeptContact& contact : state.hold.contacts) {
    if (contact.shape < 0 || contact.shape >= shapes || contact.node[0] < 0 || !hasNumbers(contact))
      return "it keeps a contact that cannot be";
    for (const int node : contact.node)
      if (node < -1 || node >= model.particle_count) return "it keeps a contact of a particle that does not exist";
  }
  return "";
}

std::string relaxationDamage(const RelaxationMemory& memory, const Model& model) {
  const auto& relaxation = model.scene.tissue.relaxation;
  const std::size_t terms = relaxation ? relaxation->ratios.size() : 0;
  const bool begun = terms > 0 && !memory.held.empty();
  if (memory.held.size() != (begun ? terms : 0) || memory.stress.empty() == begun ||
      memory.overstress.size() != terms * memory.stress.size() || (!begun && memory.energy != 0))
    return "its wall has relaxed as another one";
  double sum = memory.energy + memory.loss;
  for (const std::vector<float>* stresses : {&memory.stress, &memory.overstress})
    for (const float stress : *stresses) sum += 0 * static_cast<double>(stress);
  for (const double held : memory.held) sum += held;
  return std::isfinite(sum) ? "" : "its wall has stresses that are not numbers";
}

}  // namespace

std::string findDamage(const State& state, const Model& model) {
  const int count = model.particle_count;
  std::string damage = particleDamage(state, static_cast<std::size_t>(count));
  if (damage.empty()) damage = toolDamage(state, model);
  if (damage.empty()) damage = solverDamage(state, static_cast<std::size_t>(count));
  if (damage.empty()) damage = procedureDamage(state.procedure, count);
  if (damage.empty()) damage = holdDamage(state, model);
  if (damage.empty()) damage = pullDamage(state.pull, count);
  if (damage.empty() && !(std::isfinite(state.motion.held_time) && std::isfinite(state.motion.muscle_work)))
    damage = "its own motion is not a number";
  if (damage.empty()) damage = relaxationDamage(state.relaxation, model);
  if (damage.empty() && model.scene.marking && state.procedure.dose.empty()) damage = "its marks are missing";
  return damage;
}

}  // namespace vibe
