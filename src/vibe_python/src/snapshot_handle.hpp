#pragma once
#include <memory>
#include <string>

#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::python {

/// The Python object `Snapshot`: a state in memory, or the bytes of one whose model is not known yet.
struct SnapshotHandle {
  std::shared_ptr<const Model> model;  ///< null: bytes only
  std::shared_ptr<const State> state;
  std::string bytes;
  std::shared_ptr<const void> prepared;  ///< see Simulation::prepare()

  std::string encoded() const;
  /// The state for a model.
  /// @throws Error if it is of another one
  std::shared_ptr<const State> stateFor(const std::shared_ptr<const Model>& wanted, OtherScene other) const;
};

}  // namespace vibe::python
