#pragma once
#include <ostream>
#include <vector>

#include "fem/fem_case.hpp"
#include "output/result_row.hpp"

namespace vibe::benchmarks {

/// Runs a case and returns one row per sample: `setting` is the sample, `reference_error` the largest relative error
/// over its levels. Prints the result of each level.
std::vector<ResultRow> runCase(const FemCase& bench_case, std::ostream& log);

/// The parts of runCase.
std::vector<ResultRow> runStatic(const FemCase& bench_case, std::ostream& log);
std::vector<ResultRow> runTransient(const FemCase& bench_case, std::ostream& log);
std::vector<ResultRow> runModes(const FemCase& bench_case, std::ostream& log);

/// A row of this case without results.
ResultRow caseRow(const FemCase& bench_case, const std::string& setting, int particles);
/// Relative error, or the value itself if the sample already is a difference; NaN without a reference.
double referenceError(const Sample& sample, std::size_t level, double value);
void printSample(const Sample& sample, std::size_t level, const std::string& at, double value, std::ostream& log);

}  // namespace vibe::benchmarks
