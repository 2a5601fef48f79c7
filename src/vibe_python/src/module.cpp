#include <pybind11/pybind11.h>

#include <string>

#include "bindings.hpp"
#include "unlocked.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::python {

namespace {

namespace py = pybind11;

template <class Names>
py::tuple tupleOf(const Names& names) {
  py::tuple tuple(names.size());
  for (std::size_t k = 0; k < names.size(); ++k) tuple[k] = py::str(names[k]);
  return tuple;
}

// The layout of its arrays changed with numpy 2, which pybind11 knows from 2.12 on: before, strides would be wrong.
void checkNumpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const std::string version = py::cast<std::string>(py::module_::import("numpy").attr("__version__"));
  if (version.rfind("1.", 0) != 0)
    throw py::import_error("it was built for numpy 1, and numpy " + version +
                           " is found; use Debian's python3-numpy, 'pip install \"numpy<2\"', or the wheel of vibe");
#endif
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  checkNumpy();
  module.doc() = "The simulator library, as C++ has it; use it through the package vibe.";
  py::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  module.attr("Error").attr("__doc__") =
      "What the library raises: one sentence that names the error, its place and the remedy.";
  module.attr("Error").attr("__module__") = "vibe";
  module.attr("JOINTS") = tupleOf(kJointNames);
  module.attr("BUTTONS") = tupleOf(kButtonNames);
  bindModel(module);
  bindEvents(module);
  bindSnapshot(module);
  SimulationClass simulation(module, "Simulation",
                             "A running simulation: a model and everything that changes.\n\n"
                             "Units are SI, the frame is the world: x to the patient's front, y to the left, z to the "
                             "head. Model, state and inputs determine all that follows to the bit, whatever the number "
                             "of threads. One thread at a time may use it; long calls let other Python threads run. "
                             "Arrays named `view` show the present state for as long as they exist, without a copy, "
                             "and cannot be written; all others are new arrays.");
  bindTrainee(module);
  bindStepping(simulation);
  bindState(simulation);
  bindTool(simulation);
  bindContacts(simulation);
  bindProcedure(simulation);
  bindCamera(simulation);
  bindAnatomy(module);
  bindTechnique(module);
  bindBatch(module);
  stopThreadsAtExit();
  explainRefusals(module);
}

}  // namespace vibe::python
