// Measures speed and error of every method and setting on one scenario, and runs the cases with reference solutions.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "fem/case_runner.hpp"
#include "fem/fem_case.hpp"
#include "method/method_table.hpp"
#include "output/result_row.hpp"
#include "pulling/pulled_plate.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"

namespace {

using namespace vibe;
using namespace vibe::benchmarks;

constexpr int kOtherBranch = 1;  // exit status if a case has buckled away from the branch of its reference

struct Options {
  std::vector<std::string> cases;
  std::string csv, profile, values;
  bool quick = false, list = false, methods_only = false, pulling_only = false;
};

void addOptions(OptionList& line, Options& o) {
  line.option("--case", o.cases, "only these cases (YAML), no method table").typeName("FILE");
  line.flag("--methods", o.methods_only, "only the method table");
  line.flag("--pulling", o.pulling_only, "only the ways of pulling two bites together");
  line.option("--profile", o.profile, "with --pulling: write the mid-line of each way there (CSV)").typeName("FILE");
  line.flag("--quick", o.quick, "fewer repeats and sizes: about 50 seconds");
  line.option("--csv", o.csv, "write the rows there (- for standard output)").typeName("FILE");
  line.option("--values", o.values, "write every sample of the cases at every level or time there (CSV)")
      .typeName("FILE");
  line.flag("--list", o.list, "print the names of the shipped cases and end");
}

std::vector<std::string> shippedCases() {
  const std::string folder = resolveAddress("package://vibe_benchmarks/cases");
  std::vector<std::string> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  if (failure)
    throw Error(folder + " cannot be read (" + failure.message() + "); is vibe_benchmarks installed completely?");
  std::sort(files.begin(), files.end());
  return files;
}

/// @returns the exit status
int run(const Options& options) {
  if (options.pulling_only) {
    const std::vector<ResultRow> ways = runPulling(options.profile, std::cerr);
    report(options.csv, [&](std::ostream& out) { writeCsv(ways, out); });
    return 0;
  }
  std::vector<std::string> files = options.cases;
  if (files.empty() && !options.methods_only) files = shippedCases();
  if (options.list) {
    for (const std::string& file : files) std::cout << file << "\n";
    return 0;
  }
  std::vector<ResultRow> rows;
  std::vector<CaseValue> values;
  if (options.cases.empty()) rows = runMethods(options.quick, std::cerr);
  for (const std::string& file : files) {
    const FemCase bench_case = readCase(file);
    if (options.quick && options.cases.empty() && bench_case.slow) continue;
    const auto more = runCase(bench_case, std::cerr, values);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  report(options.csv, [&](std::ostream& out) { writeCsv(rows, out); });
  save(options.values, [&](std::ostream& out) { writeValues(values, out); });
  const bool other = std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.branch == Branch::Other; });
  return other ? kOtherBranch : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{
      "Prints time per step beside errors, for every method and setting and for cases with reference solutions. The "
      "exit "
      "status is 1 if a case has buckled away from the branch of its reference, and 2 after an error.",
      "vibe_bench"};
  addOptions(line, options);
  return runProgram(line, argc, argv, [&] { return run(options); });
}
