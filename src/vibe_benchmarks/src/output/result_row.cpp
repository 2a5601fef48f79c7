#include "output/result_row.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"

namespace vibe::benchmarks {
namespace {

std::string show(const char* format, double value) {
  if (std::isnan(value)) return "";
  if (std::isinf(value)) return "inf";  // the solution of the method diverged
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string showHash(std::uint64_t hash) {
  if (hash == 0) return "";
  char text[24];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
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

std::string percent(double fraction) {
  if (std::isinf(fraction)) return "inf";
  return std::isfinite(fraction)
             ? show(std::abs(fraction) < 1e-4 || std::abs(fraction) > 100 ? "%.1e" : "%.3f", 100 * fraction)
             : "-";
}

}  // namespace

void setTimes(std::vector<double> times, ResultRow& row) {
  if (times.empty()) return;
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(std::ceil(part * static_cast<double>(times.size()))) - 1];
  };
  row.ms_p50 = at(0.5);
  row.ms_p99 = at(0.99);
  row.ms_max = times.back();
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

void printTable(const std::vector<ResultRow>& rows, std::ostream& out) {
  printTo(out, "%-26s %-16s %-24s %7s %8s %8s %8s | %9s %9s %9s %9s %9s  %-6s %s\n", "case", "method", "setting",
          "nodes", "ms p50", "p99", "max", "motion %", "static %", "force %", "ref %", "drift %", "branch", "hash");
  for (const ResultRow& row : rows) {
    const auto ms = [](double value) { return std::isfinite(value) ? show("%.3f", value) : std::string("-"); };
    printTo(out, "%-26.26s %-16.16s %-24.24s %7d %8s %8s %8s | %9s %9s %9s %9s %9s  %-6s %s\n", row.bench_case.c_str(),
            row.method.c_str(), row.setting.c_str(), row.particles, ms(row.ms_p50).c_str(), ms(row.ms_p99).c_str(),
            ms(row.ms_max).c_str(), percent(row.motion_error).c_str(), percent(row.static_error).c_str(),
            percent(row.force_error).c_str(), percent(row.reference_error).c_str(), percent(row.energy_drift).c_str(),
            branchName(row.branch), showHash(row.state_hash).c_str());
  }
}

void save(const std::string& file, const std::function<void(std::ostream&)>& write) {
  if (file.empty()) return;
  if (file == "-") return write(std::cout);
  std::ostringstream text;
  write(text);
  writeFile(file, text.str(), "The table");
}

void printTo(std::ostream& out, const char* format, ...) {
  char text[1000];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  out << text;
}

double threadMilliseconds() {
  return 1e3 * threadCpuTime();
}

}  // namespace vibe::benchmarks
