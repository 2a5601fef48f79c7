#pragma once
#include <sys/types.h>

#include <atomic>
#include <memory>
#include <vector>

#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/simulation/wall_coverage.hpp"

namespace vibe::python {

/// What a Python object `Simulation` and its views share. It lives until the last of them is gone.
struct Session {
  Simulation simulation;
  std::vector<Event> events;             ///< of all steps of the last call
  std::unique_ptr<InspectionLens> lens;  ///< of what `sees` asked for last; null: nobody has asked

  Session(std::shared_ptr<const Model> model, const SimulationSettings& settings);
  /// One step; appends its events.
  void step(const StepInput& input);
  /// Another state takes over, in the arrays of the old one, so that views of them show it.
  void replaceState(const State& state);
};

/// The Python object: a session that can be closed, belongs to the process that made it, and serves one thread at a
/// time.
class SimulationHandle {
 public:
  SimulationHandle(std::shared_ptr<const Model> model, const SimulationSettings& settings);

  void close();
  bool closed() const { return session_ == nullptr; }

 private:
  friend class Use;

  std::shared_ptr<Session> session_;
  std::atomic<bool> busy_{false};
  pid_t process_;
};

/// The right to use a simulation, until the end of the scope.
class Use {
 public:
  /// @throws Error if it is closed, was made in another process, or is used by another thread
  explicit Use(SimulationHandle& handle);
  ~Use();
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

  Session* operator->() const { return session_.get(); }
  Session& operator*() const { return *session_; }
  const std::shared_ptr<Session>& shared() const { return session_; }
  const Model& model() const { return session_->simulation.model(); }
  const State& state() const { return session_->simulation.state(); }

 private:
  SimulationHandle& handle_;
  std::shared_ptr<Session> session_;
};

}  // namespace vibe::python
