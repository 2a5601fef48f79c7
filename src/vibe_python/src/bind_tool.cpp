#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "tool.hpp"
#include "vibe_core/simulation/tool_queries.hpp"

namespace vibe::python {

void needTool(const Model& model) {
  if (!model.tool) throw Error("The scene has no scope; add the section 'scope'.");
}

Eigen::Isometry3d linkPose(const Model& model, const State& state, int link) {
  needTool(model);
  thread_local std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  return model.tool_base * poses[static_cast<std::size_t>(link)];
}

Eigen::Matrix<double, 6, 1> wrenchOf(const State& state) {
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << state.tool_force, state.tool_torque;
  return wrench;
}

namespace {

py::object lookAheadOf(SimulationHandle& handle) {
  const Use use(handle);
  needTool(use.model());
  const auto sight = lookAhead(use.model(), use.state());
  if (!sight) return py::none();
  py::dict found;
  found["triangle"] = sight->triangle;
  found["point"] = py::array_t<double>(3, sight->point.data());
  found["normal"] = py::array_t<double>(3, sight->normal.data());
  found["distance"] = sight->distance;
  return found;
}

py::object impedance(SimulationHandle& handle) {
  const Use use(handle);
  const auto& found = use->simulation.toolImpedance();
  if (!found) return py::none();
  py::dict parameters;
  parameters["stiffness"] = matrixOf(found->stiffness);
  parameters["damping"] = matrixOf(found->damping);
  return parameters;
}

}  // namespace

void bindTool(SimulationClass& simulation) {
  simulation
      .def_property_readonly(
          "tip_pose",
          [](SimulationHandle& s) {
            const Use use(s);
            return matrixOf(linkPose(use.model(), use.state(), use.model().tip_link).matrix());
          },
          "New array (4, 4): pose of the link scope_tip in world; its x axis is the view [m].")
      .def(
          "link_pose",
          [](SimulationHandle& s, const std::string& name) {
            const Use use(s);
            needTool(use.model());
            return matrixOf(linkPose(use.model(), use.state(), use.model().tool->linkIndex(name)).matrix());
          },
          py::arg("name"), "New array (4, 4): pose of a link of the URDF in world [m].")
      .def_property_readonly(
          "wrench", [](SimulationHandle& s) { return py::array_t<double>(6, wrenchOf(Use(s).state()).eval().data()); },
          "New array (6,): force [N] and torque [N m] of the tissue on the tool, mean over the last "
          "step, about the origin of scope_tip and in its axes.")
      .def_property_readonly(
          "jacobian",
          [](SimulationHandle& s) {
            const Use use(s);
            needTool(use.model());
            return matrixOf(tipJacobian(use.model(), use.state()));
          },
          "New array (6, 4): linear and angular velocity of scope_tip in world per speed of the four "
          "joints of the scope.")
      .def("look_ahead", &lookAheadOf,
           "Where the tip looks: None, or triangle, point (3,) [m], normal (3,), distance [m].")
      .def("impedance", &impedance,
           "Of the tissue at the tip: None while nothing is touched, or stiffness and damping, as docs/interfaces.md "
           "has them.");
}

}  // namespace vibe::python
