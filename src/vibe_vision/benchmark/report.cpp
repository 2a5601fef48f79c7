#include "report.hpp"

#include <cmath>
#include <cstdio>

namespace vibe {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

double percent(double part, double whole) {
  return 100 * part / whole;
}

/// A number, or a dash where nothing was measured.
std::string text(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string timeText(const TimeSummary& time) {
  return text("%.0f", 1e6 * time.least) + "/" + text("%.0f", 1e6 * time.median);
}

std::string consistencyText(const Score& s) {
  if (!std::isfinite(s.nees)) return "-";
  return text("%.2f", s.nees) + " [" + text("%.2f", s.nees_low) + ", " + text("%.2f", s.nees_high) + "] " +
         (s.consistent() ? "in " : "OUT");
}

std::string phantomText(const Score& s) {
  return s.hidden > 0 ? text("%.0f", s.phantom) + "/" + text("%.0f", s.hidden) : "-";
}

}  // namespace

void printHeader(std::ostream& out, const ScoreLimits& limits) {
  char line[400];
  std::snprintf(line, sizeof line,
                "error: along the axis against the truth at mid-exposure, errors <= %.0f px; found: right reports in "
                "frames with >= %.0f %% of the marker visible\n(clear: fully visible); wrong: reports off by > %.1f "
                "mm; phantom: reports/frames with < %.0f %% visible;\nCRB: Cramer-Rao bound; NEES: mean and its 95 %% "
                "band; times: thread CPU, least/median\n",
                limits.outlier, 100 * limits.visible, 1e3 * limits.wrong, 100 * limits.phantom);
  out << line;
}

void printCell(std::ostream& out, const CellResult& result) {
  char line[300];
  out << "\n" << result.cell.name() << "\n";
  std::snprintf(line, sizeof line, "  %-19s %8s %8s %7s %7s %7s %6s %7s %6s %7s %-22s %10s %13s %6s\n", "method",
                "RMS px", "bias px", "x CRB", "rot deg", "found%", "clear%", "wrong%", "phant.", "in 95%", "NEES",
                "track us", "search us", "s.ok%");
  out << line;
  for (const Score& s : result.scores) {
    std::snprintf(
        line, sizeof line, "  %-19s %8s %8s %7s %7s %7s %6s %7s %6s %7s %-22s %10s %13s %6s\n", s.method.c_str(),
        text("%.4f", s.rms).c_str(), text("%+.4f", s.bias).c_str(), text("%.2f", s.boundRatio()).c_str(),
        text("%.3f", kDegrees * s.rotation_rms).c_str(), text("%.1f", percent(s.tracked, s.visible)).c_str(),
        text("%.1f", percent(s.clear_tracked, s.clear)).c_str(), text("%.2f", percent(s.wrong, s.reports)).c_str(),
        phantomText(s).c_str(), text("%.1f", 100 * s.nees_inside).c_str(), consistencyText(s).c_str(),
        timeText(s.track).c_str(), timeText(s.search).c_str(),
        text("%.1f", percent(s.search_found - s.search_wrong, s.searched)).c_str());
    out << line;
  }
  out << "  both instruments in one tracker: track " << timeText(result.track) << " us, search "
      << timeText(result.search) << " us\n"
      << std::flush;
}

void writeCsv(std::ostream& out, const std::vector<CellResult>& results) {
  out << "scene,marker_px,exposure_s,speed_m_s,width,height,method,frames,visible,tracked,clear,clear_tracked,reports,"
         "wrong,hidden,phantom,rms_px,bias_px,rotation_rms_deg,bound_px,bound_ratio,rotation_bound_deg,nees,nees_low,"
         "nees_high,nees_inside,track_min_s,track_median_s,search_min_s,search_median_s,searched,search_found,"
         "search_wrong\n";
  out.precision(6);
  for (const CellResult& result : results) {
    const Cell& c = result.cell;
    for (const Score& s : result.scores)
      out << c.scene << ',' << c.marker << ',' << c.exposure.value_or(0) << ',' << c.speed << ',' << c.width << ','
          << c.height << ',' << s.method << ',' << s.frames << ',' << s.visible << ',' << s.tracked << ',' << s.clear
          << ',' << s.clear_tracked << ',' << s.reports << ',' << s.wrong << ',' << s.hidden << ',' << s.phantom << ','
          << s.rms << ',' << s.bias << ',' << kDegrees * s.rotation_rms << ',' << s.bound << ',' << s.boundRatio()
          << ',' << kDegrees * s.rotation_bound << ',' << s.nees << ',' << s.nees_low << ',' << s.nees_high << ','
          << s.nees_inside << ',' << s.track.least << ',' << s.track.median << ',' << s.search.least << ','
          << s.search.median << ',' << s.searched << ',' << s.search_found << ',' << s.search_wrong << '\n';
    out << c.scene << ',' << c.marker << ',' << c.exposure.value_or(0) << ',' << c.speed << ',' << c.width << ','
        << c.height << ",both" << std::string(20, ',') << result.track.least << ',' << result.track.median << ','
        << result.search.least << ',' << result.search.median << ",,,\n";
  }
}

}  // namespace vibe
