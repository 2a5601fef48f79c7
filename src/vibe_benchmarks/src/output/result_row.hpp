#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace vibe::benchmarks {

constexpr double kNotApplicable = std::numeric_limits<double>::quiet_NaN();

/// Whether an equilibrium is on the branch of the reference, see CaseSymmetry.
enum class Branch { Unknown, Same, Other };

/// One measured method and setting. Errors are fractions; NaN where a quantity does not apply.
struct ResultRow {
  std::string bench_case, method, setting;
  int particles = 0, threads = 1;
  double ms_p50 = kNotApplicable, ms_p99 = kNotApplicable, ms_max = kNotApplicable;  ///< thread CPU per step [ms]
  double motion_error =
      kNotApplicable;  ///< largest distance from the time-converged motion, relative to the length of the pull
  double static_error = kNotApplicable;     ///< at rest
  double force_error = kNotApplicable;      ///< relative to the largest force
  double reference_error = kNotApplicable;  ///< relative to the reference of the case
  double energy_drift = kNotApplicable;     ///< relative to the energy at the start
  std::uint64_t state_hash = 0;             ///< FNV-1a of the last positions and velocities; 0: none
  Branch branch = Branch::Unknown;          ///< of the equilibria of a case
};

/// The value of one sample of a case at one level or time.
struct CaseValue {
  std::string bench_case, sample;
  double at = 0;                   ///< level of a static case, time of a transient one [s], number of a mode
  double value = kNotApplicable;   ///< in the unit of the sample; NaN where the solution did not converge
  double cpu_ms = kNotApplicable;  ///< thread CPU time from the value before to this one [ms]
};

/// Statistics of step times [ms].
struct StepTimes {
  double mean = 0, p50 = 0, p99 = 0, max = 0;
};
StepTimes timesOf(std::vector<double> times);
double meanOf(const std::vector<double>& values);  ///< 0 of none

/// Sets the three times from those of all steps [ms].
void setTimes(std::vector<double> times, ResultRow& row);

/// Writes "case,method,...,branch" and one line per row; empty where a quantity does not apply.
void writeCsv(const std::vector<ResultRow>& rows, std::ostream& out);
/// Writes "case,sample,at,value,cpu_ms" and one line per value; empty where a value does not exist.
void writeValues(const std::vector<CaseValue>& values, std::ostream& out);

/// Gives `write` the file of an option --csv, the standard output for "-", and nothing if it is empty.
/// @throws Error if the file cannot be written
void save(const std::string& file, const std::function<void(std::ostream&)>& write);

/// Prints a CSV table with its columns aligned to the standard error output, and saves it as save() does.
void report(const std::string& file, const std::function<void(std::ostream&)>& write);

/// CPU time of this thread [ms].
double threadMilliseconds();

}  // namespace vibe::benchmarks
