#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "output/result_row.hpp"

namespace vibe {

/// The ways of pulling two bites of the slightly domed wall of case 7 together, in the simulator's own steps of 1/60 s:
/// by the thread, by the prototype's groups, and by a condition on the bites as the case itself does, with the shell
/// and with shape matching. Rows per way and distance of the bites (30, 20, 10 mm): motion_error is the displacement
/// field and force_error the tension, both against the case's finite elements; none where a way ends before that
/// distance.
/// @param profile  the mid-line of each way as it ended is written there; empty: nowhere
std::vector<ResultRow> runPulling(const std::string& profile, std::ostream& log);

}  // namespace vibe
