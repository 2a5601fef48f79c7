#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "vibe_core/metrics/session_outcome.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::python {

namespace {

py::dict threadOf(const Suture& suture, const State& state) {
  std::vector<Eigen::Vector3d> place;
  std::vector<double> depth, time;
  py::list full;
  for (const Bite& bite : suture.bites) {
    place.push_back(bitePosition(bite, state.x, state.y, state.z));
    depth.push_back(bite.depth);
    time.push_back(bite.time);
    full.append(bite.fullThickness());
  }
  py::dict thread;
  thread["stage"] = toString(suture.stage);
  thread["technique"] = toString(static_cast<Technique>(suture.technique));
  thread["margin"] = suture.technique_margin;
  thread["bites"] = rowsOf(place);
  thread["depth"] = listOf(depth);
  thread["time"] = listOf(time);
  thread["full_thickness"] = full;
  thread["length"] = listOf(suture.length);
  thread["tension"] = listOf(suture.tension);
  thread["drawn"] = suture.pulled;
  thread["cinch_tension"] = suture.cinch_tension;
  thread["tear_outs"] = suture.tear_outs;
  return thread;
}

std::vector<py::dict> threads(SimulationHandle& handle) {
  const Use use(handle);
  std::vector<py::dict> list;
  for (const Suture& suture : use.state().procedure.sutures) list.push_back(threadOf(suture, use.state()));
  return list;
}

py::dict procedure(SimulationHandle& handle) {
  const Use use(handle);
  const ProcedureState& state = use.state().procedure;
  py::dict now;
  now["phase"] = toString(state.phase);
  now["grips"] = !use.state().grip.empty();
  now["turns"] = state.grip_turns;
  now["arm_closed"] = state.arm_closed;
  now["needle_on_arm"] = state.needle_on_arm;
  now["needle_loaded"] = state.needle_loaded;
  now["blood_lost"] = state.blood_lost;
  now["thread_used"] = state.thread_used;
  return now;
}

py::dict measures(SimulationHandle& handle) {
  const Use use(handle);
  py::dict table;
  for (const Measure& measure : measuresOf(use->simulation.metrics(), use.state().procedure.sutures)) {
    if (measure.value)
      table[py::str(measure.name)] = *measure.value;
    else
      table[py::str(measure.name)] = py::none();
  }
  return table;
}

py::dict measureUnits() {
  py::dict units;
  for (const Measure& measure : measuresOf(SessionMetrics(), {})) units[py::str(measure.name)] = measure.unit;
  return units;
}

py::dict recognise(const py::handle& bites, bool printed) {
  const auto rows = numbers(bites, "bites", {-1, 3});
  std::vector<Eigen::Vector3d> points;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) points.emplace_back(rows.at(i, 0), rows.at(i, 1), rows.at(i, 2));
  const TechniqueResult found = recogniseTechnique(points, printed ? TechniqueRule::Printed : TechniqueRule::Corrected);
  py::dict result;
  result["technique"] = toString(found.technique);
  result["margin"] = found.margin;
  result["transitions"] = py::make_tuple(found.transitions[0], found.transitions[1]);
  return result;
}

}  // namespace

void bindProcedure(SimulationClass& simulation) {
  simulation
      .def(
          "threads", &threads,
          "A dictionary per suture set: stage, technique, margin; bites (n, 3) [m], depth (n,) [m], time (n,) [s], "
          "full_thickness: n booleans; length (n-1,) [m] and tension (n-1,) [N] between them; drawn [m], cinch_tension "
          "[N], tear_outs.")
      .def("procedure", &procedure,
           "A dictionary: phase, grips, turns, arm_closed, needle_on_arm, needle_loaded, blood_lost [m^3], "
           "thread_used [m].")
      .def("measures", &measures,
           "Measures of skill by name (docs/metrics.md), since the start or the last restore(); None where the session "
           "does not define one. Units: vibe.measure_units().");
}

void bindTechnique(py::module_& module) {
  module.def("measure_units", &measureUnits, "Units of Simulation.measures() by name, SI; '1' for counts and shares.");
  module.def("recognise_technique", &recognise, py::arg("bites"), flag("printed", false),
             "The stitch pattern of bites (n, 3) in any unit: technique, margin from 0 to 1, transitions. printed: by "
             "the rule of the ViBE paper as printed.");
}

}  // namespace vibe::python
