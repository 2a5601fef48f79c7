#pragma once

#include <array>
#include <ostream>
#include <string>
#include <vector>

#include "vibe_core/model/tissue_solver.hpp"

namespace vibe::benchmarks {

/// How often the steps of a case took each way on which a step goes on where something is not as foreseen, and what the
/// steps cost that did.
class WayCounts {
 public:
  explicit WayCounts(std::string name) : name_(std::move(name)) {}

  void add(const StepReport& report);
  /// CSV: one line per way that was taken, after writeWayHeader().
  void write(std::ostream& out) const;

 private:
  struct Sum {
    int steps = 0;
    double evaluations = 0;
  };
  std::string name_;
  Sum all_;
  std::array<Sum, kStepWayCount> of_;  // steps that took each
};

void writeWayHeader(std::ostream& out);

}  // namespace vibe::benchmarks
