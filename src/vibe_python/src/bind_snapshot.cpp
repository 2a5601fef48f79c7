#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "snapshot_handle.hpp"
#include "vibe_core/simulation/snapshot.hpp"

namespace vibe::python {

namespace py = pybind11;

std::string SnapshotHandle::encoded() const {
  return model ? encodeSnapshot(*model, *state) : bytes;
}

std::shared_ptr<const State> SnapshotHandle::stateFor(const std::shared_ptr<const Model>& wanted,
                                                      OtherScene other) const {
  if (model == wanted) return state;
  return std::make_shared<const State>(decodeSnapshot(*wanted, encoded(), "in memory", other));
}

void bindSnapshot(py::module_& module) {
  const auto fromBytes = [](const py::bytes& bytes) {
    return SnapshotHandle{nullptr, nullptr, std::string(bytes), nullptr};
  };
  py::class_<SnapshotHandle>(module, "Snapshot",
                             "The state of a simulation at one time. Cheap to make and to restore; can be pickled.")
      .def(py::init(fromBytes), py::arg("bytes"), "Of the bytes of a snapshot; they are checked when it is restored.")
      .def(
          "to_bytes", [](const SnapshotHandle& s) { return py::bytes(s.encoded()); },
          "The bytes, as Simulation.save() writes them to a file.")
      .def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; })
      .def(py::pickle([](const SnapshotHandle& s) { return py::bytes(s.encoded()); }, fromBytes));
}

}  // namespace vibe::python
