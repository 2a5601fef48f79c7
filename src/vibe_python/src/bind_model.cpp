#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "model_handle.hpp"
#include "unlocked.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"

namespace vibe::python {

namespace {

// The overrides as a scene that begins with another one; JSON is YAML, with numbers in SI. Their place is the working
// directory, so that relative paths lead from there, but sentences name the function.
Scene sceneWith(const std::string& address, const std::string& overrides) {
  const std::string file = resolveAddress(address);
  if (overrides.empty()) return loadScene(file);
  loadScene(file);  // what is wrong in the file itself has its own place
  const std::string base = std::filesystem::absolute(file).string();
  const auto escaped = py::cast<std::string>(py::module_::import("json").attr("dumps")(base));
  const std::string place = (std::filesystem::current_path() / "load()").string();
  try {
    return parseScene("{\"base\": " + escaped + ", " + overrides.substr(1), place);
  } catch (const Error& error) {
    const std::string text = error.what(), before = place + ":1: ";
    throw Error(text.rfind(before, 0) == 0 ? "load(): " + text.substr(before.size()) : text);
  }
}

ModelHandle build(const std::string& address, const std::string& overrides, const std::string& mesh) {
  const Unlocked others;
  Scene scene = [&] {
    const py::gil_scoped_acquire acquired;
    return sceneWith(address, overrides);
  }();
  ModelHandle handle;
  if (!mesh.empty()) handle.mesh_report = useMesh(scene, std::filesystem::absolute(resolveAddress(mesh)));
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  handle.model = buildModel(scene, urdf, [](const std::string&, double) {
    const py::gil_scoped_acquire acquired;
    checkSignals();
  });
  return handle;
}

ModelHandle buildAndWarn(const std::string& address, const std::string& overrides, const std::string& mesh) {
  constexpr int kCallerOfLoad = 2;
  ModelHandle handle = build(address, overrides, mesh);
  for (const std::string& warning : warningsAbout(*handle.model))
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), kCallerOfLoad) != 0) throw py::error_already_set();
  return handle;
}

py::array triangles(const ModelHandle& handle) {
  const auto& list = handle.model->organ.surface.triangles;
  return view(list.empty() ? nullptr : list.front().data(), {static_cast<py::ssize_t>(list.size()), 3}, handle.model);
}

template <class Enum>
py::array codes(const std::vector<Enum>& list, const ModelHandle& handle) {
  static_assert(sizeof(Enum) == 1);
  return view(reinterpret_cast<const std::uint8_t*>(list.data()), {static_cast<py::ssize_t>(list.size())},
              handle.model);
}

py::dict jointLimits(const ModelHandle& handle) {
  py::dict limits;
  for (std::size_t k = 0; handle.model->tool && k < kJointNames.size(); ++k) {
    const JointLimits& limit = handle.model->tool->limits()[k];
    limits[kJointNames[k]] = py::make_tuple(limit.lower, limit.upper, limit.velocity);
  }
  return limits;
}

py::array_t<double> inverseKinematics(const ModelHandle& handle, const py::handle& position,
                                      const py::handle& direction, const py::handle& start) {
  const Model& model = *handle.model;
  if (!model.tool) throw Error("The scene has no scope; add the section 'scope'.");
  const Eigen::Vector3d x = vector3(direction, "direction");
  if (x.norm() < 1e-9) throw Error("'direction' has no length; give one that is not zero.");
  const auto given = numbers(start, "start", {kJointCount});
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
  target.translation() = vector3(position, "position");
  target.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), x).toRotationMatrix();
  std::array<double, kJointCount> from{};
  std::copy_n(given.data(), kJointCount, from.begin());
  const auto joints = model.tool->inverseKinematics(model.tool_base.inverse() * target, from);
  return py::array_t<double>(kJointCount, joints.data());
}

py::array_t<double> forwardKinematics(const ModelHandle& handle, const py::handle& joints) {
  const Model& model = *handle.model;
  if (!model.tool) throw Error("The scene has no scope; add the section 'scope'.");
  const auto given = numbers(joints, "joints", {kJointCount});
  std::array<double, kJointCount> inputs{};
  std::copy_n(given.data(), kJointCount, inputs.begin());
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(inputs, poses);
  return matrixOf((model.tool_base * poses[static_cast<std::size_t>(model.tip_link)]).matrix());
}

}  // namespace

void bindModel(py::module_& module) {
  py::class_<ModelHandle> model(
      module, "Model", "Everything that is constant during a simulation. Shared between simulations and threads.");
  model
      .def("__reduce__",
           [](const py::object&) -> py::object {
             throw py::type_error("A Model cannot be pickled or copied; call vibe.load() again in the other process.");
           })
      .def(py::init([](const py::args&, const py::kwargs&) -> ModelHandle {
             throw Error("A Model is not made directly; call vibe.load().");
           }),
           "Made by vibe.load().")
      .def_property_readonly(
          "particles", [](const ModelHandle& m) { return m.model->particle_count; }, "Number of particles of the wall.")
      .def_property_readonly(
          "step_period", [](const ModelHandle& m) { return m.model->scene.step_period; },
          "Simulated time per step [s].")
      .def_property_readonly(
          "scene", [](const ModelHandle& m) { return toYaml(m.model->scene); },
          "The scene as YAML with every key, in SI units.")
      .def_property_readonly(
          "name", [](const ModelHandle& m) { return m.model->scene.name; }, "Name of the scene.")
      .def_property_readonly("triangles", &triangles, "View (triangles, 3) int32: particle numbers, oriented outwards.")
      .def_property_readonly(
          "rest_positions", [](const ModelHandle& m) { return rowsOf(m.model->organ.surface.vertices); },
          "New array (particles, 3): the wall without stress [m].")
      .def_property_readonly(
          "region", [](const ModelHandle& m) { return codes(m.model->organ.region, m); },
          "View (particles,) uint8: 0 cardia, 1 fundus, 2 body, 3 antrum, 4 pylorus.")
      .def_property_readonly(
          "wall", [](const ModelHandle& m) { return codes(m.model->organ.wall, m); },
          "View (particles,) uint8: 0 anterior, 1 greater curvature, 2 posterior, 3 lesser curvature.")
      .def_property_readonly(
          "end", [](const ModelHandle& m) { return codes(m.model->organ.end, m); },
          "View (particles,) uint8: 0 none, 1 oesophagus, 2 duodenum, which hold the organ.")
      .def_property_readonly(
          "mass", [](const ModelHandle& m) { return view(m.model->mass, m.model); }, "View (particles,) [kg].")
      .def_property_readonly(
          "area", [](const ModelHandle& m) { return view(m.model->area, m.model); },
          "View (particles,): wall at rest [m^2].")
      .def_property_readonly(
          "particle_radius", [](const ModelHandle& m) { return m.model->particle_radius; },
          "Half the mean thickness of the wall [m].")
      .def_property_readonly("joint_limits", &jointLimits,
                             "Dictionary: joint to (lower, upper, speed) [m], [rad], [m/s], [rad/s].")
      .def_property_readonly(
          "mesh_report", [](const ModelHandle& m) { return m.mesh_report; },
          "What was guessed of an imported mesh, as the text of its sidecar file; empty if nothing was.")
      .def("forward_kinematics", &forwardKinematics, py::arg("joints"),
           "New array (4, 4): pose of scope_tip in world with the joints (7,), while nothing bends the scope [m].")
      .def("inverse_kinematics", &inverseKinematics, py::arg("position"), py::arg("direction"), py::arg("start"),
           "Joints (7,) that bring the tip to a position (3,) [m], looking along direction (3,), from the joints start "
           "(7,); the best there are, if none do.")
      .def("__repr__", [](const ModelHandle& m) {
        return "<vibe.Model '" + m.model->scene.name + "', " + std::to_string(m.model->particle_count) + " particles>";
      });
  module.def("build_model", &buildAndWarn, py::arg("scene"), py::arg("overrides"), py::arg("mesh"),
             "The model of a scene file. overrides: a JSON object on top of it, or empty; mesh: a surface file, or "
             "empty. vibe.load() is the friendlier way.");
}

}  // namespace vibe::python
