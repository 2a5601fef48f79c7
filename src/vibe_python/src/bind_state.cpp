#include <pybind11/pybind11.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "vibe_core/constraints/breathing.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::python {

namespace {

// A view of a list of the state.
template <class T>
auto viewOf(std::vector<T> State::*list) {
  return [list](SimulationHandle& handle) {
    const Use use(handle);
    return view(use.state().*list, use.shared());
  };
}

template <class T>
auto viewOf(std::vector<T> ProcedureState::*list) {
  return [list](SimulationHandle& handle) {
    const Use use(handle);
    return view(use.state().procedure.*list, use.shared());
  };
}

py::array_t<double> stacked(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
  py::array_t<double> array({static_cast<py::ssize_t>(x.size()), py::ssize_t{3}});
  double* out = array.mutable_data();
  for (std::size_t i = 0; i < x.size(); ++i) {
    *out++ = x[i];
    *out++ = y[i];
    *out++ = z[i];
  }
  return array;
}

SurfaceMesh present(const Use& use) {
  SurfaceMesh mesh{{}, use.model().organ.surface.triangles};
  const State& state = use.state();
  mesh.vertices.reserve(state.x.size());
  for (std::size_t i = 0; i < state.x.size(); ++i) mesh.vertices.emplace_back(state.x[i], state.y[i], state.z[i]);
  return mesh;
}

py::array_t<float> strain(SimulationHandle& handle) {
  const Use use(handle);
  py::array_t<float> array(use.model().particle_count);
  use.model().tissue->strain(use.state(), array.mutable_data());
  return array;
}

void bindViews(SimulationClass& simulation) {
  simulation.def_property_readonly("x", viewOf(&State::x), "View (particles,): positions [m].")
      .def_property_readonly("y", viewOf(&State::y), "View (particles,): positions [m].")
      .def_property_readonly("z", viewOf(&State::z), "View (particles,): positions [m].")
      .def_property_readonly("vx", viewOf(&State::vx), "View (particles,): velocities [m/s].")
      .def_property_readonly("vy", viewOf(&State::vy), "View (particles,): velocities [m/s].")
      .def_property_readonly("vz", viewOf(&State::vz), "View (particles,): velocities [m/s].")
      .def_property_readonly("heat", viewOf(&ProcedureState::heat),
                             "View (particles,) float32: heat of the argon beam; (0,) without marking.")
      .def_property_readonly("dose", viewOf(&ProcedureState::dose),
                             "View (particles,) float32: dose of the argon beam [J]; (0,) without marking.")
      .def_property_readonly("burn_grade", viewOf(&ProcedureState::grade),
                             "View (particles,) uint8: 0 none, then mark, burn, deep burn; (0,) without marking.");
}

void bindArrays(SimulationClass& simulation) {
  simulation
      .def_property_readonly(
          "positions",
          [](SimulationHandle& handle) {
            const Use use(handle);
            return stacked(use.state().x, use.state().y, use.state().z);
          },
          "New array (particles, 3): positions [m].")
      .def_property_readonly(
          "velocities",
          [](SimulationHandle& handle) {
            const Use use(handle);
            return stacked(use.state().vx, use.state().vy, use.state().vz);
          },
          "New array (particles, 3): velocities [m/s].")
      .def_property_readonly(
          "normals", [](SimulationHandle& handle) { return rowsOf(vertexNormals(present(Use(handle)))); },
          "New array (particles, 3): unit normals out of the lumen.")
      .def_property_readonly("strain", &strain,
                             "New array (particles,) float32: mean stretch in the wall relative to rest, minus 1.");
}

void bindScalars(SimulationClass& simulation) {
  simulation
      .def_property_readonly(
          "pressure", [](SimulationHandle& s) { return Use(s).state().pressure; }, "Of the gas, above ambient [Pa].")
      .def_property_readonly(
          "volume", [](SimulationHandle& s) { return Use(s).state().volume; }, "Of the lumen [m^3].")
      .def_property_readonly(
          "motion",
          [](SimulationHandle& handle) {
            const Use use(handle);
            const OrganPhases at = organPhases(use.model().scene, use.state());
            const MotionState& motion = use.state().motion;
            return py::dict(py::arg("breath_phase") = at.breath, py::arg("wave_phase") = at.wave,
                            py::arg("heart_phase") = at.heart, py::arg("breath_held") = motion.held,
                            py::arg("breath_held_time") = motion.held_time,
                            py::arg("muscle_work") = motion.muscle_work);
          },
          "New dict: what moves the organ by itself, as on the topic organ/motion: parts of a breath, of the period "
          "of\n"
          "contraction waves and of a beat, 0 to 1; whether and for how long the breath was held [s]; work of the "
          "muscle [J].")
      .def_property_readonly(
          "joints",
          [](SimulationHandle& s) {
            const Use use(s);
            return py::array_t<double>(kJointCount, use.state().joints.data());
          },
          "New array (7,): where the hand has the joints, in the order of vibe.JOINTS [m], [rad].");
}

}  // namespace

void bindState(SimulationClass& simulation) {
  bindViews(simulation);
  bindArrays(simulation);
  bindScalars(simulation);
}

}  // namespace vibe::python
