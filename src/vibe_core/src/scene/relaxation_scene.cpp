#include <algorithm>
#include <numeric>

#include "vibe_core/scene/scene.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {

namespace {
constexpr std::size_t kMostTerms = 5;  // two and a half decades of time with two terms each need no more. Design choice
constexpr double kLeastSteps = 5;      // of a time: the error of a step is below a tenth of a strain's change in it
}  // namespace

double relaxingShare(const RelaxationScene& relaxation) {
  return std::accumulate(relaxation.ratios.begin(), relaxation.ratios.end(), 0.0);
}

std::string relaxationFault(const RelaxationScene& relaxation, double step_period) {
  const std::size_t ratios = relaxation.ratios.size(), times = relaxation.times.size();
  if (ratios != times)
    return "has " + std::to_string(ratios) + " ratios and " + std::to_string(times) +
           " times; write one time per ratio";
  if (ratios == 0 || ratios > kMostTerms)
    return "has " + std::to_string(ratios) + " terms; write 1 to " + std::to_string(kMostTerms);
  const double share = relaxingShare(relaxation);
  if (!(share < 1))
    return "has ratios whose sum is " + showQuantity(share, "") + ", which leaves no stress; write less than 1 in all";
  const double shortest = *std::min_element(relaxation.times.begin(), relaxation.times.end());
  if (shortest < kLeastSteps * step_period)
    return "has a time of " + showQuantity(shortest, "s") + ", and a step takes " + showQuantity(step_period, "s") +
           "; write times of five steps at least";
  return "";
}

}  // namespace vibe
