#include "contact/bench_tools.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {

namespace {

constexpr double kAnyForce = 1e6;  // [N]
constexpr double kSmooth = 0.02;   // radius of the wall whose mean normal counts [m]

std::string link(const std::string& name) {
  return "<link name=\"" + name + "\"/>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& axis) {
  std::string text = "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
                     "\"/><child link=\"" + child + "\"/>";
  if (type != "fixed")
    text += "<axis xyz=\"" + axis + "\"/><limit lower=\"" + (type == "prismatic" ? "0" : "-1000") +
            "\" upper=\"1000\" velocity=\"100000\" effort=\"1000\"/>";
  return text + "</joint>\n";
}

}  // namespace

std::string freeHandUrdf() {
  std::string text = "<robot name=\"hand\">\n";
  for (const char* name :
       {"scope_base", "slide", "shaft", "ring", "scope_tip", "scope_camera_optical", "helix_slide", "helix", "needle"})
    text += link(name);
  text += joint("insertion", "prismatic", "scope_base", "slide", "1 0 0");
  text += joint("rotation", "revolute", "slide", "shaft", "1 0 0");
  text += joint("tip_up_down", "revolute", "shaft", "ring", "0 -1 0");
  text += joint("tip_left_right", "revolute", "ring", "scope_tip", "0 0 1");
  text += joint("camera", "fixed", "scope_tip", "scope_camera_optical", "1 0 0");
  text += joint("helix_advance", "prismatic", "scope_tip", "helix_slide", "1 0 0");
  text += joint("helix_rotation", "revolute", "helix_slide", "helix", "1 0 0");
  text += joint("needle_driver", "prismatic", "scope_tip", "needle", "1 0 0");
  return text + "</robot>\n";
}

void holdByHand(const Eigen::Vector3d& tip, const Eigen::Vector3d& direction, Scene& scene) {
  if (!scene.scope) scene.scope.emplace();
  if (!scene.helix) scene.helix.emplace();
  scene.scope->base_from_anatomy = false;
  scene.scope->base_position = tip - kHandStart * direction;
  scene.scope->base_rpy = {0, std::asin(-direction.z()), std::atan2(direction.y(), direction.x())};
  scene.helix->hold_force = kAnyForce;
  scene.helix->initial_hold_force = kAnyForce;
}

Eigen::Vector3d inwardsAt(const SurfaceView& wall, const Eigen::Vector3d& place) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const auto& t : wall.triangles) {
    const Eigen::Vector3d a = wall.position(t[0]), b = wall.position(t[1]), c = wall.position(t[2]);
    if (((a + b + c) / 3 - place).norm() < kSmooth) normal += (b - a).cross(c - a);
  }
  return -normal.normalized();
}

namespace {

void setAttribute(const std::string& name, double value, std::size_t from, std::size_t to, std::string& text) {
  const std::string opening = name + "=\"";
  const std::size_t begin = text.find(opening, from) + opening.size();
  const std::size_t end = text.find('"', begin);
  if (begin < from || end > to) throw Error("A <limit> of the URDF has no attribute " + name + "; add it.");
  text.replace(begin, end - begin, formatted("%.17g", value));
}

}  // namespace

std::string withJointLimits(std::string urdf, const std::string& joint, const JointLimits& limits) {
  const std::size_t at = urdf.find("<joint name=\"" + joint + "\"");
  const std::size_t closing = at == std::string::npos ? at : urdf.find("</joint>", at);
  const std::size_t limit = at == std::string::npos ? at : urdf.find("<limit", at);
  if (closing == std::string::npos || limit == std::string::npos || limit > closing)
    throw Error("The URDF has no joint '" + joint + "' with a limit; the hard cases need it.");
  const auto end = [&] { return urdf.find('>', limit); };
  setAttribute("lower", limits.lower, limit, end(), urdf);
  setAttribute("upper", limits.upper, limit, end(), urdf);
  setAttribute("velocity", limits.velocity, limit, end(), urdf);
  return urdf;
}

std::shared_ptr<Model> modelWith(const Scene& scene, const std::string& urdf, const Model& like) {
  auto model = std::make_shared<Model>();
  model->scene = scene;
  model->organ = like.organ;
  finishModel(urdf, *model);
  return model;
}

double insertionAtContact(const std::shared_ptr<const Model>& model, State& state) {
  Simulation simulation(model, SimulationSettings::study(1));
  simulation.replaceState(state);
  StepInput input = holdAt(state);
  while (simulation.state().tool_force.norm() < kTouch) {
    if (input.joints[Insertion] >= model->tool->limits()[Insertion].upper)
      throw Error("The scope does not reach the wall; the state of contact needs it.");
    input.joints[Insertion] += kApproach * simulation.stepPeriod();
    simulation.step(input);
  }
  const double touching = simulation.state().joints[Insertion];
  input.joints[Insertion] = touching - kClearance;
  for (long k = std::lround(1 / simulation.stepPeriod()); k > 0; --k) simulation.step(input);
  state = simulation.state();
  return touching;
}

}  // namespace vibe::benchmarks
