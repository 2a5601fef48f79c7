#pragma once
#include <ostream>
#include <vector>

#include "output/result_row.hpp"

namespace vibe::benchmarks {

/// Compares every setting on the wall of 3,618 particles with one time-converged motion, and likewise the simulator's
/// shape matching on the same mesh. Also measures pulls to 30, 40 and 50 mm, and the cost for growing numbers of
/// particles.
/// @param quick  fewer sizes and pulls
std::vector<ResultRow> runMethods(bool quick, std::ostream& log);

}  // namespace vibe::benchmarks
