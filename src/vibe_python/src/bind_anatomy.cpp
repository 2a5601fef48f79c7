#include <pybind11/pybind11.h>

#include <memory>

#include "arrays.hpp"
#include "bindings.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"

namespace vibe::python {

namespace {

/// The map refers to the organ of the model, which it keeps.
struct Anatomy {
  std::shared_ptr<const Model> model;
  AnatomicalMap map;
};

std::unique_ptr<Anatomy> anatomyOf(SimulationHandle& handle) {
  const Use use(handle);
  const State& state = use.state();
  std::vector<Eigen::Vector3d> vertices;
  vertices.reserve(state.x.size());
  for (std::size_t i = 0; i < state.x.size(); ++i) vertices.emplace_back(state.x[i], state.y[i], state.z[i]);
  const auto& model = use->simulation.sharedModel();
  return std::unique_ptr<Anatomy>(new Anatomy{model, AnatomicalMap(model->organ, std::move(vertices))});
}

py::tuple asTuple(const WallPoint& point) {
  return py::make_tuple(point.triangle, py::array_t<double>(3, point.weight.data()));
}

WallPoint pointOf(const Anatomy& anatomy, int triangle, const py::handle& weight) {
  if (triangle < 0 || triangle >= static_cast<int>(anatomy.model->organ.surface.triangles.size()))
    throw Error("'triangle' is not a triangle of the wall; give a number below that of Model.triangles.");
  return {triangle, vector3(weight, "weight")};
}

}  // namespace

void bindAnatomy(py::module_& module) {
  py::class_<Anatomy>(
      module, "Anatomy",
      "Anatomical coordinates of a stomach in the shape that it has when this is made: along its axis, 0 "
      "apex of the fundus to 1 duodenum, and around it, angle from the greater curvature [rad], positive "
      "to the front. A place of the wall is a triangle and the weights (3,) of its corners.")
      .def(py::init(&anatomyOf), py::arg("simulation"), "Takes some 40 ms for 3,618 particles.")
      .def(
          "at", [](const Anatomy& a, double along, double around) { return asTuple(a.map.at(along, around)); },
          py::arg("along"), py::arg("around"),
          "The wall at a place: (triangle, weight (3,)). Raises vibe.Error in the openings of the organ.")
      .def(
          "along", [](const Anatomy& a, int t, const py::handle& w) { return a.map.along(pointOf(a, t, w)); },
          py::arg("triangle"), py::arg("weight"), "Position along the axis, 0 to 1.")
      .def(
          "around", [](const Anatomy& a, int t, const py::handle& w) { return a.map.around(pointOf(a, t, w)); },
          py::arg("triangle"), py::arg("weight"), "Angle around the axis [rad].")
      .def(
          "position",
          [](const Anatomy& a, int t, const py::handle& w) {
            return py::array_t<double>(3, a.map.position(pointOf(a, t, w)).eval().data());
          },
          py::arg("triangle"), py::arg("weight"), "New array (3,) [m].")
      .def(
          "outward",
          [](const Anatomy& a, int t, const py::handle& w) {
            return py::array_t<double>(3, a.map.outward(pointOf(a, t, w)).eval().data());
          },
          py::arg("triangle"), py::arg("weight"), "New array (3,): unit vector out of the lumen.")
      .def_property_readonly(
          "axis_length", [](const Anatomy& a) { return a.map.axisLength(); }, "Length of the axis [m].");
}

}  // namespace vibe::python
