#include "output/result_row.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"

namespace vibe::benchmarks {
namespace {

std::string show(const char* format, double value) {
  if (std::isnan(value)) return "";
  if (std::isinf(value)) return "inf";  // the solution of the method diverged
  return formatted(format, value);
}

std::string showHash(std::uint64_t hash) {
  if (hash == 0) return "";
  return formatted("%016" PRIx64, hash);
}

const char* branchName(Branch branch) {
  return branch == Branch::Unknown ? "" : branch == Branch::Same ? "same" : "other";
}

/// Quotes a field, because a comma or quote in a name would shift the columns.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// The cells of a line of CSV.
std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Columns side by side, or below one another where there are more of them than rows.
void printTable(std::istream& csv, std::ostream& out) {
  std::vector<std::vector<std::string>> cells;
  for (std::string line; std::getline(csv, line);) cells.push_back(cellsOf(line));
  const bool turned = cells.front().size() > cells.size();
  const std::size_t rows = turned ? cells.front().size() : cells.size();
  const std::size_t columns = turned ? cells.size() : cells.front().size();
  const auto at = [&](std::size_t r, std::size_t c) { return turned ? cells[c].at(r) : cells[r].at(c); };
  std::vector<std::size_t> width(columns, 0);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) width[c] = std::max(width[c], at(r, c).size());
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c)
      out << std::left << std::setw(static_cast<int>(width[c])) << at(r, c) << (c + 1 < columns ? "  " : "\n");
}

}  // namespace

double meanOf(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

StepTimes timesOf(std::vector<double> times) {
  if (times.empty()) return {};
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(std::ceil(part * static_cast<double>(times.size()))) - 1];
  };
  return {meanOf(times), at(0.5), at(0.99), times.back()};
}

void setTimes(std::vector<double> times, ResultRow& row) {
  if (times.empty()) return;
  const StepTimes found = timesOf(std::move(times));
  row.ms_p50 = found.p50, row.ms_p99 = found.p99, row.ms_max = found.max;
}

void writeCsv(const std::vector<ResultRow>& rows, std::ostream& out) {
  out << "case,method,setting,particles,threads,ms_p50,ms_p99,ms_max,motion_error,static_error,force_error,"
         "reference_error,energy_drift,state_hash,branch\n";
  for (const ResultRow& row : rows) {
    out << field(row.bench_case) << ',' << field(row.method) << ',' << field(row.setting) << ',' << row.particles << ','
        << row.threads;
    for (const double value : {row.ms_p50, row.ms_p99, row.ms_max, row.motion_error, row.static_error, row.force_error,
                               row.reference_error, row.energy_drift})
      out << ',' << show("%.6g", value);
    out << ',' << showHash(row.state_hash) << ',' << branchName(row.branch) << '\n';
  }
}

void writeValues(const std::vector<CaseValue>& values, std::ostream& out) {
  out << "case,sample,at,value,cpu_ms\n";
  for (const CaseValue& v : values)
    out << field(v.bench_case) << ',' << field(v.sample) << ',' << show("%.9g", v.at) << ',' << show("%.9g", v.value)
        << ',' << show("%.4f", v.cpu_ms) << '\n';
}

void save(const std::string& file, const std::function<void(std::ostream&)>& write) {
  if (file.empty()) return;
  if (file == "-") return write(std::cout);
  std::ostringstream text;
  write(text);
  writeFile(file, text.str(), "The table");
}

void report(const std::string& file, const std::function<void(std::ostream&)>& write) {
  std::stringstream csv;
  write(csv);
  printTable(csv, std::cerr);
  save(file, [&](std::ostream& out) { out << csv.str(); });
}

double threadMilliseconds() {
  return 1e3 * threadCpuTime();
}

}  // namespace vibe::benchmarks
