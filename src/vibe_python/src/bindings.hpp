#pragma once
#include <pybind11/pybind11.h>

#include <memory>

#include "session.hpp"

namespace vibe::python {

/// The class `Simulation`, to which each subject adds its part.
using SimulationClass = pybind11::class_<SimulationHandle, std::shared_ptr<SimulationHandle>>;

void bindModel(pybind11::module_& module);
void bindEvents(pybind11::module_& module);
void bindSnapshot(pybind11::module_& module);
void bindTrainee(pybind11::module_& module);
void bindAnatomy(pybind11::module_& module);
void bindTechnique(pybind11::module_& module);
void bindBatch(pybind11::module_& module);

/// An argument that takes True and False only; others are true or false by accident.
inline pybind11::arg_v flag(const char* name, bool value) {
  return pybind11::arg(name).noconvert() = value;
}

/// A call that fits no function raises TypeError with one sentence: what was given, and what it takes. To be called
/// once everything is bound.
void explainRefusals(pybind11::module_& module);

void bindStepping(SimulationClass& simulation);
void bindState(SimulationClass& simulation);
void bindTool(SimulationClass& simulation);
void bindContacts(SimulationClass& simulation);
void bindProcedure(SimulationClass& simulation);
void bindCamera(SimulationClass& simulation);

}  // namespace vibe::python
