#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "output/result_row.hpp"

namespace vibe::benchmarks {

/// Compares the methods of pulling two bites of the slightly domed wall of case 7 together, in the simulator's own
/// steps of 1/60 s: by the thread, by the groups of the prototype, and by a condition on the bites as in the case
/// itself, with the shell and with shape matching. One row per method and distance of the bites (30, 20, 10 mm):
/// motion_error is that of the displacement field and force_error that of the tension, both relative to the finite
/// elements of the case; empty if a method ends before that distance.
/// @param profile  file for the final mid-line of each method; empty: none
std::vector<ResultRow> runPulling(const std::string& profile, std::ostream& log);

}  // namespace vibe::benchmarks
