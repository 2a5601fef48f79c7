#include "session.hpp"

#include <unistd.h>

#include <utility>

#include "vibe_core/program/error.hpp"

namespace vibe::python {

namespace {

/// In a child of fork() the threads of a simulation do not exist: it can neither be used nor ended, and is left.
struct EndInOwnProcess {
  pid_t process;
  void operator()(Session* session) const {
    if (::getpid() == process) delete session;
  }
};

}  // namespace

Session::Session(std::shared_ptr<const Model> model, const SimulationSettings& settings)
    : simulation(std::move(model), settings) {}

void Session::step(const StepInput& input) {
  const std::vector<Event>& happened = simulation.step(input);
  events.insert(events.end(), happened.begin(), happened.end());
}

void Session::replaceState(const State& state) {
  // the metrics begin anew with the state; the arrays stay where they are, since lists of one length are copied in
  // place
  State kept = std::move(simulation.editState());
  simulation.replaceState(state);
  kept = simulation.state();
  simulation.editState() = std::move(kept);
  events.clear();
}

SimulationHandle::SimulationHandle(std::shared_ptr<const Model> model, const SimulationSettings& settings)
    : session_(new Session(std::move(model), settings), EndInOwnProcess{::getpid()}), process_(::getpid()) {}

void SimulationHandle::close() {
  if (closed()) return;
  { const Use use(*this); }  // not while another thread steps it
  session_.reset();
}

Use::Use(SimulationHandle& handle) : handle_(handle) {
  if (handle.process_ != ::getpid())
    throw Error(
        "The simulation was made in another process, whose threads this one does not have; make it after the fork, "
        "or start processes by 'spawn'.");
  if (handle.busy_.exchange(true))
    throw Error("The simulation is in use by another thread; give every thread a simulation of its own.");
  session_ = handle.session_;
  if (session_ != nullptr) return;
  handle.busy_ = false;
  throw Error("The simulation is closed; make another one of the same model.");
}

Use::~Use() {
  handle_.busy_ = false;
}

}  // namespace vibe::python
