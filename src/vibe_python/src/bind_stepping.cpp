#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "input.hpp"
#include "model_handle.hpp"
#include "snapshot_handle.hpp"
#include "trainee_handle.hpp"
#include "unlocked.hpp"
#include "vibe_core/simulation/snapshot.hpp"

namespace vibe::python {

namespace {

std::shared_ptr<SimulationHandle> make(const ModelHandle& model, std::optional<std::uint64_t> seed, int threads,
                                       bool metrics, bool impedance) {
  if (threads < 1 || threads > 1024) throw Error("'threads' is not from 1 to 1024; give the threads inside a step.");
  SimulationSettings settings;
  settings.seed = seed;
  settings.threads = threads;
  settings.metrics = metrics;
  settings.impedance = impedance;
  const Unlocked others;
  return std::make_shared<SimulationHandle>(model.model, settings);
}

// Calls step() until it returns false, with the GIL released; Ctrl+C ends it between two steps.
template <class Step>
void repeat(const Step& step) {
  for (bool goes_on = true; goes_on;) {
    {
      const Unlocked others;
      for (std::int64_t k = 0; k < kStepsBetweenLooks && goes_on; ++k) goes_on = step();
    }
    checkSignals();
  }
}

std::vector<Event> step(SimulationHandle& handle, const py::kwargs& keywords) {
  const Use use(handle);
  const StepInput input = changedInput(use->simulation.input(), keywords, use.model());
  use->events.clear();
  {
    const Unlocked others;
    use->step(input);
  }
  return use->events;
}

std::vector<Event> run(SimulationHandle& handle, std::int64_t steps, const py::kwargs& keywords) {
  if (steps < 0) throw Error("'steps' is negative; give how many steps are to be taken.");
  const Use use(handle);
  const StepInput input = changedInput(use->simulation.input(), keywords, use.model());
  use->events.clear();
  repeat([&] {
    if (steps-- <= 0) return false;
    use->step(input);
    return true;
  });
  return use->events;
}

std::vector<Event> follow(SimulationHandle& handle, TraineeHandle& trainee, std::optional<double> seconds) {
  if (seconds && !(*seconds >= 0)) throw Error("'seconds' is negative or not a number; give simulated time.");
  const Use use(handle);
  const TraineeHandle::Turn turn(trainee);
  trainee.checkModel(use.model());
  std::int64_t left = -1;
  if (seconds) left = std::llround(std::min(*seconds, 1e9) / use->simulation.stepPeriod());
  use->events.clear();
  repeat([&] {
    if (left == 0 || trainee.done(use->simulation)) return false;
    --left;
    use->step(trainee.next(use->simulation));
    return true;
  });
  return use->events;
}

SnapshotHandle snapshot(SimulationHandle& handle, bool prepared) {
  const Use use(handle);
  const Unlocked others;
  return {use->simulation.sharedModel(), std::make_shared<const State>(use.state()), "",
          prepared ? use->simulation.prepare() : nullptr};
}

OtherScene takenIf(bool other_model) {
  return other_model ? OtherScene::Taken : OtherScene::Refused;
}

void restore(SimulationHandle& handle, const SnapshotHandle& snapshot, bool other_model) {
  const Use use(handle);
  const Unlocked others;
  use->replaceState(*snapshot.stateFor(use->simulation.sharedModel(), takenIf(other_model)));
}

void reset(SimulationHandle& handle, std::optional<std::uint64_t> seed) {
  const Use use(handle);
  use->replaceState(initialState(use.model(), seed.value_or(use.model().scene.seed)));
}

void bindLife(SimulationClass& simulation) {
  simulation
      .def(
          py::init(&make), py::arg("model"), py::arg("seed") = py::none(), py::arg("threads") = 1,
          flag("metrics", true), flag("impedance", true),
          "Begins at the initial state. seed: instead of the scene's; threads: inside a step, results do not depend on "
          "them; metrics=False: measures() stays empty; impedance=False: impedance() stays None, which saves time and "
          "memory, and hash(), which covers its past, differs once the tool has touched something.")
      .def("__reduce__",
           [](const py::object&) -> py::object {
             throw py::type_error(
                 "A Simulation cannot be pickled or copied; pickle its snapshot(), and restore() that in "
                 "another Simulation of the same scene.");
           })
      .def("close", &SimulationHandle::close, "Ends it; views stay valid. Whatever uses it later raises vibe.Error.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](SimulationHandle& s, const py::args&) { s.close(); })
      .def_property_readonly("closed", &SimulationHandle::closed, "Whether close() was called.")
      .def(
          "warm_up",
          [](SimulationHandle& s) {
            const Use use(s);
            use->simulation.warmUp();
          },
          py::call_guard<Unlocked>(), "Takes the time that the first step needs besides; changes no result.");
}

void bindSteps(SimulationClass& simulation) {
  static const std::string step_help = std::string("One step.\n\n") + kInputHelp + "\nReturns what happened.";
  static const std::string run_help = std::string("Some steps with one input.\n\n") + kInputHelp +
                                      "\nReturns what happened. Ctrl+C ends it after a step.";
  simulation.def("step", &step, step_help.c_str())
      .def("run", &run, py::arg("steps"), run_help.c_str())
      .def("follow", &follow, py::arg("trainee"), py::arg("seconds") = py::none(),
           "Lets a Trainee or a Script give the input, until it has ended, or for simulated seconds. Returns what "
           "happened.")
      .def_property_readonly(
          "input", [](SimulationHandle& s) { return asKeywords(Use(s)->simulation.input()); },
          "The input in force, as keywords of step().")
      .def_property_readonly(
          "events", [](SimulationHandle& s) { return Use(s)->events; },
          "What happened in the last call of step(), run() or follow().")
      .def_property_readonly(
          "time", [](SimulationHandle& s) { return Use(s).state().time; }, "Simulated time [s].")
      .def_property_readonly(
          "steps", [](SimulationHandle& s) { return Use(s).state().step; },
          "Steps since the initial state, through snapshots.");
}

void bindSnapshots(SimulationClass& simulation) {
  simulation
      .def_property_readonly(
          "model",
          [](SimulationHandle& s) {
            return ModelHandle{Use(s)->simulation.sharedModel(), ""};
          },
          "Its model.")
      .def(
          "hash", [](SimulationHandle& s) { return Use(s)->simulation.hash(); },
          "64 bits of all of the state: equal hashes mean equal states, and, with one model, equal futures.")
      .def("snapshot", &snapshot, flag("prepared", false),
           "The present state, in memory. prepared=True, for states that many simulations go back to: keeps what the "
           "first step after restore() takes long to make, too (a megabyte with 1,000 particles), with the same "
           "results.")
      .def(
          "restore", &restore, py::arg("snapshot"), flag("other_model", false),
          "Back to a state; views show it. The input then holds the joints where they are, and no button but "
          "helix_grab and "
          "cinch, if they were pressed. Raises vibe.Error if it is of another model; other_model=True takes one of the "
          "same organ, step and parts whose scene has other values, such as of the tissue.")
      .def("reset", &reset, py::arg("seed") = py::none(), "Back to the initial state.")
      .def(
          "save", [](SimulationHandle& s, const std::string& file) { Use(s)->simulation.saveSnapshot(file); },
          py::arg("file"), "Writes a snapshot.")
      .def(
          "load",
          [](SimulationHandle& s, const std::string& file, bool other_model) {
            const Use use(s);
            use->replaceState(loadSnapshot(use.model(), file, takenIf(other_model)));
          },
          py::arg("file"), flag("other_model", false),
          "Back to the state of a snapshot that save() or a node has written; see restore().");
}

}  // namespace

void bindStepping(SimulationClass& simulation) {
  bindLife(simulation);
  bindSteps(simulation);
  bindSnapshots(simulation);
}

}  // namespace vibe::python
