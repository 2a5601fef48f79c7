#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <utility>

#include "bindings.hpp"
#include "input.hpp"
#include "model_handle.hpp"
#include "trainee_handle.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/trainee/observation.hpp"
#include "vibe_core/trainee/protocol.hpp"

namespace vibe::python {

namespace py = pybind11;

TraineeHandle::Turn::Turn(TraineeHandle& handle) : handle_(handle) {
  if (handle.busy_.exchange(true))
    throw Error("The trainee is in use by another thread; give every thread a trainee of its own.");
}

namespace {

class LookingTrainee : public TraineeHandle {
 public:
  LookingTrainee(std::shared_ptr<const Model> model, const Protocol& protocol, std::optional<double> novice,
                 std::optional<std::uint64_t> seed)
      : model_(model),
        trainee_(std::move(model), novice ? between(Skill::expert(), Skill::novice(), *novice) : protocol.skill,
                 seed.value_or(protocol.seed)) {
    for (const Goal& goal : protocol.goals) trainee_.add(goal);
  }

  bool done(const Simulation& /*simulation*/) const override { return trainee_.done(); }
  StepInput next(const Simulation& simulation) override { return trainee_.next(observe(simulation)); }
  void checkModel(const Model& model) const override {
    if (&model != model_.get())
      throw Error("The trainee was made for another model than that of the simulation; make one for this model.");
  }
  const Trainee& trainee() const { return trainee_; }

 private:
  std::shared_ptr<const Model> model_;
  Trainee trainee_;
};

class ScriptedTrainee : public TraineeHandle {
 public:
  explicit ScriptedTrainee(TraineeScript script) : script_(std::move(script)) {}

  bool done(const Simulation& simulation) const override {
    return simulation.time() >= script_.duration() - simulation.stepPeriod() / 2;
  }
  StepInput next(const Simulation& simulation) override { return script_.at(simulation.time()); }
  void checkModel(const Model& /*model*/) const override {}
  const TraineeScript& script() const { return script_; }

 private:
  TraineeScript script_;
};

// One line without a colon is the name of a file.
bool isText(const std::string& source) {
  if (source.empty()) throw Error("The name of a file is empty; give one, or the text of a protocol or script.");
  return source.find('\n') != std::string::npos || source.find(": ") != std::string::npos;
}

std::shared_ptr<LookingTrainee> makeTrainee(const ModelHandle& model, const std::string& protocol,
                                            std::optional<double> novice, std::optional<std::uint64_t> seed) {
  if (novice && !(*novice >= 0 && *novice <= 1))
    throw Error("'novice' is not from 0 to 1; give 0 for an expert, 1 for a novice.");
  const Protocol read =
      isText(protocol) ? Protocol::parse(protocol, "protocol") : Protocol::load(resolveAddress(protocol));
  return std::make_shared<LookingTrainee>(model.model, read, novice, seed);
}

py::dict nextInput(TraineeHandle& trainee, SimulationHandle& handle) {
  const Use use(handle);
  const TraineeHandle::Turn turn(trainee);
  trainee.checkModel(use.model());
  return asKeywords(trainee.next(use->simulation));
}

std::vector<py::dict> results(const LookingTrainee& handle) {
  std::vector<py::dict> list;
  for (const GoalOutcome& outcome : goalOutcomes(handle.trainee())) {
    py::dict result;
    result["goal"] = outcome.goal;
    result["reached"] = outcome.reached;
    result["reason"] = outcome.reason;
    list.push_back(result);
  }
  return list;
}

}  // namespace

void bindTrainee(py::module_& module) {
  py::class_<TraineeHandle, std::shared_ptr<TraineeHandle>>(module, "InputSource",
                                                            "What gives the input of each step: Trainee or Script.")
      .def(py::init([](const py::args&, const py::kwargs&) -> std::shared_ptr<TraineeHandle> {
             throw Error("An InputSource is not made directly; make a vibe.Trainee or a vibe.Script.");
           }),
           "Made as Trainee or Script.")
      .def("next", &nextInput, py::arg("simulation"),
           "The input of the next step, as keywords of Simulation.step(). To be called once before every step.");
  py::class_<LookingTrainee, TraineeHandle, std::shared_ptr<LookingTrainee>>(
      module, "Trainee", "A trainee that looks and pursues the goals of a protocol (docs/protocols.md).")
      .def(py::init(&makeTrainee), py::arg("model"), py::arg("protocol"), py::arg("novice") = py::none(),
           py::arg("seed") = py::none(),
           "protocol: a file, package://PACKAGE/file, or the text of one; novice: skill instead of the protocol's, 0 "
           "expert to 1 novice; seed: of aim errors and tremor, instead of the protocol's.")
      .def_property_readonly(
          "done", [](const LookingTrainee& t) { return t.trainee().done(); }, "Whether every goal has ended.")
      .def_property_readonly(
          "activity", [](const LookingTrainee& t) { return t.trainee().activity(); },
          "What it is doing: 'bite 3 of 7, second try'.")
      .def_property_readonly("results", &results, "A dictionary per goal: goal, reached, reason.");
  py::class_<ScriptedTrainee, TraineeHandle, std::shared_ptr<ScriptedTrainee>>(
      module, "Script", "Motions of joints and buttons over time (docs/trainee_scripts.md).")
      .def(py::init([](const std::string& file) {
             return std::make_shared<ScriptedTrainee>(isText(file) ? TraineeScript::parse(file, "script")
                                                                   : TraineeScript::load(resolveAddress(file)));
           }),
           py::arg("file"), "A file, package://PACKAGE/file, or the text of one.")
      .def_property_readonly(
          "duration", [](const ScriptedTrainee& t) { return t.script().duration(); }, "How long it takes [s].");
}

}  // namespace vibe::python
