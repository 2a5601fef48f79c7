#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/trainee.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe::python {

/// The Python objects `Trainee` and `Script`: what gives the input of each step.
class TraineeHandle {
 public:
  virtual ~TraineeHandle() = default;
  virtual bool done(const Simulation& simulation) const = 0;
  virtual StepInput next(const Simulation& simulation) = 0;
  /// @throws Error if it was made for another model
  virtual void checkModel(const Model& model) const = 0;

  /// The right to use it, until the end of the scope.
  class Turn {
   public:
    /// @throws Error if another thread uses it
    explicit Turn(TraineeHandle& handle);
    ~Turn() { handle_.busy_ = false; }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    TraineeHandle& handle_;
  };

 private:
  std::atomic<bool> busy_{false};
};

}  // namespace vibe::python
