#include "vibe_core/contact/shaft_bend.hpp"

#include <algorithm>
#include <cstddef>

namespace vibe {

namespace {

// Adds the part of one interval between two stations to the share of the station at which the hat is 1. Simpson's rule
// is exact for these products of two linear functions.
// @param begin, end  of the interval [m]
// @param from, to    the hat at the two
void addInterval(double begin, double end, double from, double to, double length, ShaftBend::Share& share) {
  const double reach = std::min(end, length) - begin;
  if (!(reach > 0)) return;
  for (const auto& [place, weight] : {std::pair{0.0, 1.0 / 6}, {0.5, 4.0 / 6}, {1.0, 1.0 / 6}}) {
    const double at = begin + place * reach;
    const double hat = from + (to - from) * (at - begin) / (end - begin);
    share.mean += weight * reach * hat;
    share.change += weight * reach * hat * (1 - 2 * at / length);
    share.change_rate += weight * reach * hat * 2 * at / (length * length);
  }
  if (!(length < end)) return;
  const double last = from + (to - from) * (length - begin) / (end - begin);  // at the entry, which moves
  share.mean_rate += last;
  share.change_rate -= last;
}

}  // namespace

ShaftBend::ShaftBend(const std::vector<double>& stations, double free_length, const ToolDisplacement& displacement)
    : displacement_(displacement) {
  constexpr double kFarAway = 1e3;  // the last station takes all that lies behind it [m]
  if (!(free_length > 0)) return;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double here = stations[i];
    if (i > 0) addInterval(stations[i - 1], here, 0, 1, free_length, shares_[i]);
    const bool last = i + 1 == stations.size();
    addInterval(here, last ? kFarAway : stations[i + 1], 1, last ? 1 : 0, free_length, shares_[i]);
  }
}

double ShaftBend::angle(int station, int direction) const {
  const std::size_t dof = static_cast<std::size_t>(kShaftDof + 2 * direction);
  return share(station).mean * displacement_[dof] + share(station).change * displacement_[dof + 1];
}

double ShaftBend::angleRate(int station, int direction) const {
  const std::size_t dof = static_cast<std::size_t>(kShaftDof + 2 * direction);
  return share(station).mean_rate * displacement_[dof] + share(station).change_rate * displacement_[dof + 1];
}

}  // namespace vibe
