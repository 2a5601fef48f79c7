#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace vibe::vision {
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

struct Column {
  const char* title;
  int width;  ///< negative: to the left
  std::function<std::string(const Score&)> text;
};

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {
      {"method", -18, [](const Score& s) { return s.method; }},
      {"RMS px", 7, [](const Score& s) { return text("%.4f", s.rms); }},
      {"bias px", 8, [](const Score& s) { return text("%+.4f", s.bias); }},
      {"x CRB", 6, [](const Score& s) { return text("%.2f", s.boundRatio()); }},
      {"rot deg", 7, [](const Score& s) { return text("%.3f", kDegrees * s.rotation_rms); }},
      {"found%", 6, [](const Score& s) { return text("%.1f", percent(s.tracked, s.visible)); }},
      {"clear%", 6, [](const Score& s) { return text("%.1f", percent(s.clear_tracked, s.clear)); }},
      {"wrong%", 6, [](const Score& s) { return text("%.2f", percent(s.wrong, s.reports)); }},
      {"phantom", 7, phantomText},
      {"in 95%", 6, [](const Score& s) { return text("%.1f", 100 * s.nees_inside); }},
      {"NEES", 23, consistencyText},
      {"lead mm", 7, [](const Score& s) { return text("%.3f", 1e3 * s.lead_rms); }},
      {"track us", 9, [](const Score& s) { return timeText(s.track); }},
      {"search us", 11, [](const Score& s) { return timeText(s.search); }},
      {"s.ok%", 5, [](const Score& s) { return text("%.1f", percent(s.search_found - s.search_wrong, s.searched)); }}};
  return all;
}

std::string padded(const std::string& text, int width) {
  const std::string space(static_cast<std::size_t>(std::max(0, std::abs(width) - static_cast<int>(text.size()))), ' ');
  return width < 0 ? text + space : space + text;
}

}  // namespace

void printHeader(std::ostream& out, const ScoreLimits& limits) {
  char line[400];
  std::snprintf(
      line, sizeof line,
      "error: along the axis against the truth at mid-exposure, errors <= %.0f px; found: right reports in "
      "frames with >= %.0f %% of the marker visible\n(clear: fully visible); wrong: reports off by > %.1f "
      "mm; phantom: reports/frames with < %.0f %% visible;\nCRB: Cramer-Rao bound; NEES: mean and its 95 %% "
      "band; lead: the slide %.0f ms ahead;\ntimes: thread CPU, least/median; s.ok: right reports of a search\n",
      limits.outlier, 100 * limits.visible, 1e3 * limits.wrong, 100 * limits.phantom, 1e3 * kLead);
  out << line;
}

void printCell(std::ostream& out, const CellResult& result) {
  out << "\n" << result.cell.name() << "\n ";
  for (const Column& column : columns()) out << ' ' << padded(column.title, column.width);
  for (const Score& score : result.scores) {
    out << "\n ";
    for (const Column& column : columns()) out << ' ' << padded(column.text(score), column.width);
  }
  out << "\n  both instruments in one tracker: track " << timeText(result.track) << " us, search "
      << timeText(result.search) << " us\n"
      << std::flush;
}

void writeCsv(std::ostream& out, const std::vector<CellResult>& results) {
  out << "scene,marker_px,exposure_s,speed_m_s,width,height,method,frames,visible,tracked,clear,clear_tracked,reports,"
         "wrong,hidden,phantom,rms_px,bias_px,rotation_rms_deg,bound_px,bound_ratio,rotation_bound_deg,nees,nees_low,"
         "nees_high,nees_inside,lead_rms_m,track_min_s,track_median_s,search_min_s,search_median_s,searched,search_"
         "found,"
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
          << s.nees_inside << ',' << s.lead_rms << ',' << s.track.least << ',' << s.track.median << ','
          << s.search.least << ',' << s.search.median << ',' << s.searched << ',' << s.search_found << ','
          << s.search_wrong << '\n';
    out << c.scene << ',' << c.marker << ',' << c.exposure.value_or(0) << ',' << c.speed << ',' << c.width << ','
        << c.height << ",both" << std::string(21, ',') << result.track.least << ',' << result.track.median << ','
        << result.search.least << ',' << result.search.median << ",,,\n";
  }
}

}  // namespace vibe::vision
