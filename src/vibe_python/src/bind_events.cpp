#include <pybind11/pybind11.h>

#include <string>

#include "bindings.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::python {

namespace py = pybind11;

void bindEvents(py::module_& module) {
  py::class_<Event>(module, "Event", "Something that happened in a step.")
      .def(py::init([](const py::args&, const py::kwargs&) -> Event {
             throw Error("An Event is not made directly; Simulation.step() returns them.");
           }),
           "Made by Simulation.step().")
      .def_property_readonly(
          "kind", [](const Event& e) { return toString(e.kind); }, "'grab', 'bite missed', ...")
      .def_property_readonly(
          "text", [](const Event& e) { return describe(e); }, "One sentence for people.")
      .def_property_readonly(
          "region", [](const Event& e) { return toString(e.region); }, "Where, if the kind has it.")
      .def_property_readonly(
          "wall", [](const Event& e) { return toString(e.wall); }, "Where, if the kind has it.")
      .def_property_readonly(
          "reason", [](const Event& e) { return toString(e.reason); }, "Why a command was rejected; 'none' otherwise.")
      .def_readonly("time", &Event::time, "Simulated time at the end of the step [s].")
      .def_readonly("particle", &Event::particle, "Nearest particle; -1: none.")
      .def_readonly("value", &Event::value, "Depends on the kind, see docs/interfaces.md.")
      .def_readonly("limit", &Event::limit, "What the value is compared with.")
      .def_readonly("amount", &Event::amount, "A second number.")
      .def_readonly("suture", &Event::suture, "Number from 0; -1: none.")
      .def_readonly("bite", &Event::bite, "Number from 0; -1: none.")
      .def("__repr__", [](const Event& e) {
        return "<vibe.Event " + std::string(toString(e.kind)) + " at " + std::to_string(e.time) + " s: " + describe(e) +
               ">";
      });
}

}  // namespace vibe::python
