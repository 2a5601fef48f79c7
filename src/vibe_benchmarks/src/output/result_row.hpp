#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace vibe {

constexpr double kNotApplicable = std::numeric_limits<double>::quiet_NaN();

/// One measured method and setting. Errors are fractions; NaN where a figure does not apply.
struct ResultRow {
  std::string bench_case, method, setting;
  int particles = 0, threads = 1;
  double ms_p50 = kNotApplicable, ms_p99 = kNotApplicable, ms_max = kNotApplicable;  ///< thread CPU per step [ms]
  double motion_error = kNotApplicable;     ///< largest distance to the time-converged motion over the pull's length
  double static_error = kNotApplicable;     ///< at rest
  double force_error = kNotApplicable;      ///< over the largest force
  double reference_error = kNotApplicable;  ///< against the reference of the case
  double energy_drift = kNotApplicable;     ///< over the energy at the start
  std::uint64_t state_hash = 0;             ///< FNV-1a of the last positions and velocities; 0: none
};

/// Sets the three times from those of all steps [ms].
void setTimes(std::vector<double> times, ResultRow& row);

/// "case,method,...,state_hash" and one line per row; empty where a figure does not apply.
void writeCsv(const std::vector<ResultRow>& rows, std::ostream& out);
/// The same for reading, errors in percent.
void printTable(const std::vector<ResultRow>& rows, std::ostream& out);

/// FNV-1a, 64 bit, of numbers. Chain by passing the last value.
std::uint64_t hashNumbers(const double* values, std::size_t count, std::uint64_t from = 0xcbf29ce484222325ULL);

/// CPU time of this thread [ms].
double threadMilliseconds();

}  // namespace vibe
