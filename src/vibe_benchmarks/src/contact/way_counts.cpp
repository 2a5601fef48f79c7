#include "contact/way_counts.hpp"

namespace vibe::benchmarks {

void WayCounts::add(const StepReport& report) {
  const auto count = [&](Sum& sum) {
    ++sum.steps;
    sum.evaluations += report.evaluations;
  };
  count(all_);
  for (std::size_t k = 0; k < kStepWayCount; ++k)
    if (report.ways.of(static_cast<StepWay>(k)) > 0) count(of_[k]);
}

void WayCounts::write(std::ostream& out) const {
  for (std::size_t k = 0; k < kStepWayCount; ++k) {
    const Sum& sum = of_[k];
    if (sum.steps == 0) continue;
    printTo(out, "%s,%d,%s,%d,%.3g,%.3g\n", name_.c_str(), all_.steps, nameOf(static_cast<StepWay>(k)), sum.steps,
            sum.evaluations / sum.steps, all_.evaluations / all_.steps);
  }
}

void writeWayHeader(std::ostream& out) {
  out << "case,steps,way,taken,evaluations,evaluations_of_all\n";
}

}  // namespace vibe::benchmarks
