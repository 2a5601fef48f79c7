#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "arithmetic/turn.hpp"
#include "constraints/supports.hpp"
#include "geometry/regions.hpp"
#include "tissue/cluster_builder.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/builder/scope_fit.hpp"
#include "vibe_core/builder/tissue_registry.hpp"
#include "vibe_core/constraints/gas.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

void setMasses(Model& model) {
  const std::size_t n = model.organ.surface.vertices.size();
  model.area = vertexAreas(model.organ.surface);
  model.mass.resize(n);
  model.inverse_mass.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    model.mass[i] = model.scene.tissue.density * model.organ.thickness[i] * model.area[i];
    model.inverse_mass[i] = isHeld(model.scene, model.organ.end[i]) ? 0 : 1 / model.mass[i];
  }
  const double sum = std::accumulate(model.organ.thickness.begin(), model.organ.thickness.end(), 0.0);
  model.particle_radius = 0.5 * sum / static_cast<double>(n);
}

Eigen::Isometry3d poseFromRpy(const Eigen::Vector3d& position, const std::array<double, 3>& rpy) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotationFromRpy(rpy);
  pose.translation() = position;
  return pose;
}

// x points along the entry, z as far to the front of the patient as possible: "up" in the image is anterior at
// rotation 0
Eigen::Isometry3d poseFromAnatomy(const Organ& organ) {
  const Eigen::Vector3d x = organ.entry_axis.normalized();
  Eigen::Vector3d z = organ.landmarks.anterior - x.dot(organ.landmarks.anterior) * x;
  if (z.norm() < 1e-6) z = x.unitOrthogonal();
  z.normalize();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().col(0) = x;
  pose.linear().col(1) = z.cross(x);
  pose.linear().col(2) = z;
  pose.translation() = organ.entry;
  return pose;
}

void addTool(const std::string& tool_urdf, Model& model) {
  const ScopeScene& scope = *model.scene.scope;
  const NeedleArm arm = scope.needle_arm && model.scene.tissue.model == "shell" ? NeedleArm::Body : NeedleArm::Drawn;
  model.tool = std::make_shared<const ToolModel>(ToolModel::fromUrdf(tool_urdf, scope.urdf, arm));
  if (scope.compliance) model.scope_springs.emplace(*model.tool, *scope.compliance);
  model.tip_link = model.tool->linkIndex("scope_tip");
  model.helix_link = model.tool->linkIndex("helix");
  model.grip_link = model.tool->joints()[static_cast<std::size_t>(model.helix_link) - 1].parent_link;
  model.needle_link = model.tool->linkIndex("needle");
  model.tool_base =
      scope.base_from_anatomy ? poseFromAnatomy(model.organ) : poseFromRpy(scope.base_position, scope.base_rpy);
}

bool hasStomachEnds(const Organ& organ) {
  bool oesophagus = false, duodenum = false;
  for (End end : organ.end) oesophagus |= end == End::Oesophagus, duodenum |= end == End::Duodenum;
  return oesophagus && duodenum && organ.landmarks.fundus != organ.landmarks.pylorus;
}

std::vector<double> placesAlong(const Organ& organ) {
  std::vector<double> along;
  along.reserve(organ.surface.vertices.size());
  if (hasStomachEnds(organ)) {
    const StomachAxis axis = findAxis(organ);
    for (int v = 0; v < static_cast<int>(organ.surface.vertices.size()); ++v)
      along.push_back(axis.lengthAt(v) / axis.length());
    return along;
  }
  for (const Eigen::Vector3d& v : organ.surface.vertices) along.push_back(v.dot(organ.entry_axis));
  const auto [min, max] = std::minmax_element(along.begin(), along.end());
  const double begin = *min, length = *max - *min;
  for (double& place : along) place = (place - begin) / length;
  return along;
}

// The gas acts as an explicit spring on the volume. In a small or light organ, a substep can be too long for it: in the
// breathing mode, to which the wall contributes little, h^2 dp/dV sum(a^2 / m) has the same limit as for the wall.
int substepsForGas(const Model& model) {
  if (!model.scene.gas) return 1;
  double compliance = 0;
  for (int i = 0; i < model.particle_count; ++i) compliance += model.area[i] * model.area[i] * model.inverse_mass[i];
  const double highest =
      kAmbientPressure + std::max(model.scene.gas->initial_pressure, model.scene.gas->regulated_pressure);
  const double rate2 = highest / model.rest_volume * compliance;
  return static_cast<int>(std::ceil(model.scene.step_period * std::sqrt(rate2 / kMaxTotalGain)));
}

void checkSubstepsForGas(int substeps, int needed) {
  if (substeps >= needed) return;
  throw Error("tissue.substeps " + std::to_string(substeps) +
              " is too few for the gas in this organ, the step would be unstable; use at least " +
              std::to_string(needed) + ", or leave it out.");
}

}  // namespace

std::shared_ptr<const Model> buildModel(const Scene& scene, const std::string& tool_urdf, const Progress& progress) {
  auto model = std::make_shared<Model>();
  model->scene = scene;
  model->organ = buildOrgan(scene, progress);
  finishModel(tool_urdf, *model, progress);
  return model;
}

void finishModel(const std::string& tool_urdf, Model& model, const Progress& progress) {
  if (progress) progress("building the tissue model", 0.9);
  model.particle_count = static_cast<int>(model.organ.surface.vertices.size());
  setMasses(model);
  model.rest_volume = enclosedVolume(model.organ.surface);
  const bool carried = model.scene.foundation && model.scene.foundation->carries_weight;
  if (model.scene.gravity && !carried) model.unbalanced_gravity = model.scene.gravity->acceleration;
  const int for_gas = substepsForGas(model);
  const TissueAndSolver made = makeTissue(model.scene, model.organ, model.mass, model.area, for_gas);
  model.tissue = made.tissue;
  model.solver = made.solver;
  model.substeps = made.substeps;
  if (model.solver->usesSubsteps()) checkSubstepsForGas(model.substeps, for_gas);
  if (model.solver->usesSubsteps() && (model.scene.breathing || model.scene.motion))
    throw Error(std::string("The section '") + (model.scene.breathing ? "breathing" : "motion") +
                "' needs the implicit solver; choose tissue.model: shell, or remove the section.");
  if (model.scene.scope) addTool(tool_urdf, model);
  if (model.scene.marking) model.dose_law.emplace(model.scene.marking->apc);
  if (model.scene.suture || breathingOf(model.scene)) model.along = placesAlong(model.organ);
  if (model.scene.suture) model.cinch = findCinchModel(model.scene.suture->cinch_model);
  if (model.scene.render_surface) model.render_surface = makeLoopSubdivision(model.organ.surface);
  if (progress) progress("ready", 1.0);
}

std::string softnessWarning(const Model& model) {
  const double ratio = model.tissue->stiffnessRatio();
  if (ratio > 0.999) return "";
  return formatted(
      "The wall has only %.0f %% of its stiffness in places; raise tissue.substeps from %d to %.0f, or lower "
      "tissue.stiffness_damping.",
      100 * ratio, model.substeps, std::ceil(model.substeps / std::sqrt(ratio)));
}

std::string weightWarning(const Model& model) {
  const Scene& scene = model.scene;
  const bool stated = scene.gravity && scene.gravity->acceleration != GravityScene().acceleration;
  if (!stated || !scene.foundation || !scene.foundation->carries_weight) return "";
  return "The stated gravity.acceleration does not act on the wall, because the foundation carries the weight whatever "
         "its direction; set foundation.carries_weight: false.";
}

std::vector<std::string> warningsAbout(const Model& model) {
  std::vector<std::string> warnings;
  for (std::string& warning : std::array{softnessWarning(model), fitWarning(model), weightWarning(model)})
    if (!warning.empty()) warnings.push_back(std::move(warning));
  return warnings;
}

State initialState(const Model& model, std::uint64_t seed) {
  State state;
  state.seed = seed;
  state.random = seed;
  const std::size_t n = static_cast<std::size_t>(model.particle_count);
  for (auto* v : {&state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az, &state.qx, &state.qy, &state.qz,
                  &state.wx, &state.wy, &state.wz})
    v->assign(n, 0);
  state.qw.assign(n, 1);
  for (const Eigen::Vector3d& p : model.organ.surface.vertices) {
    state.x.push_back(p.x());
    state.y.push_back(p.y());
    state.z.push_back(p.z());
  }
  state.volume = model.rest_volume;
  if (model.scene.marking) {
    state.procedure.heat.assign(n, 0);
    state.procedure.dose.assign(n, 0);
    state.procedure.grade.assign(n, 0);
  }
  if (model.scene.gas) {
    state.gas_amount = gasAmount(model.scene.gas->initial_pressure, state.volume);
    state.pressure = gaugePressure(state.gas_amount, state.volume);
  }
  if (model.tool)
    for (int i = 0; i < kJointCount; ++i)
      state.joints[i] = std::clamp(0.0, model.tool->limits()[i].lower, model.tool->limits()[i].upper);
  return state;
}

}  // namespace vibe
