#pragma once

#include <array>
#include <ostream>
#include <string>

#include "output/result_row.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/model/tissue_solver.hpp"

namespace vibe::benchmarks {

/// How often the steps of a case took each way on which a step goes on where something is not as foreseen, and what the
/// steps cost that did.
class WayCounts {
 public:
  explicit WayCounts(std::string name) : name_(std::move(name)) {}

  void add(const StepReport& report) {
    const auto count = [&](Sum& sum) {
      ++sum.steps;
      sum.evaluations += report.evaluations;
    };
    count(all_);
    for (std::size_t k = 0; k < kStepWayCount; ++k)
      if (report.ways.of(static_cast<StepWay>(k)) > 0) count(of_[k]);
  }
  /// CSV: one line per way that was taken, after writeWayHeader().
  void write(std::ostream& out) const {
    for (std::size_t k = 0; k < kStepWayCount; ++k) {
      const Sum& sum = of_[k];
      if (sum.steps == 0) continue;
      out << formatted("%s,%d,%s,%d,%.3g,%.3g\n", name_.c_str(), all_.steps, nameOf(static_cast<StepWay>(k)), sum.steps,
                       sum.evaluations / sum.steps, all_.evaluations / all_.steps);
    }
  }

 private:
  struct Sum {
    int steps = 0;
    double evaluations = 0;
  };
  std::string name_;
  Sum all_;
  std::array<Sum, kStepWayCount> of_;  // steps that took each
};

inline void writeWayHeader(std::ostream& out) {
  out << "case,steps,way,taken,evaluations,evaluations_of_all\n";
}

}  // namespace vibe::benchmarks
