#include <cinttypes>
#include <cstdio>

#include "suture/pattern_study.hpp"

namespace vibe::benchmarks {

void printPatterns(const std::vector<PatternRow>& rows, std::ostream& out) {
  char line[400];
  out << "pattern sets mmHg  N    half mm | volume mL      less | length less  curvature | area less  least | strain "
         "mean"
         "  95 %  | stress kPa      | tension drawn | events\n";
  for (const PatternRow& row : rows) {
    const OrganMeasures &a = row.before.organ, &b = row.after.organ;
    std::snprintf(
        line, sizeof line,
        "%-7s %dx%d %5.1f %4.1f %6.0f    | %5.0f %5.0f %5.2f %% | %8.2f %% %9.2f %% | %6.2f %% %6.1f %% | %4.1f to "
        "%4.1f %% %5.1f %% | %4.1f to %4.1f | %4.2f N %4.0f mm | %d torn, %d broken, %d loose, %d recovered%s%s\n",
        row.layout.pattern.c_str(), row.layout.sets, row.layout.bites, row.pressure / kMillimetreOfMercury,
        row.cinch_tension, 1e3 * row.layout.half_width, 1e6 * a.volume, 1e6 * b.volume, percentLess(a.volume, b.volume),
        percentLess(a.length, b.length), percentLess(a.greater_curvature, b.greater_curvature),
        percentLess(a.mean_area, b.mean_area), percentLess(a.min_area, b.min_area), 100 * row.before.mean_strain,
        100 * row.after.mean_strain, 100 * row.after.high_strain, 1e-3 * row.before.mean_stress,
        1e-3 * row.after.mean_stress, row.mean_tension, 1e3 * row.drawn, row.torn_out, row.broken, row.loose,
        row.recoveries, row.crossed ? ", walls CROSS" : "", row.at_rest ? "" : ", NOT at rest");
    out << line;
  }
}

void writePatterns(const std::vector<PatternRow>& rows, std::ostream& out) {
  out << "pattern,sets,bites,pressure,cinch_tension,half_width,volume_before,volume,length_before,length,"
         "curvature_before,curvature,area_before,area,least_area_before,least_area,strain_before,strain,"
         "high_strain_before,high_strain,stress_before,stress,energy_before,energy,mean_tension,least_tension,drawn,"
         "torn_out,broken,loose,recoveries,crossed,at_rest,state_hash\n";
  char text[40];
  for (const PatternRow& row : rows) {
    const PatternMeasures &a = row.before, &b = row.after;
    out << row.layout.pattern << ',' << row.layout.sets << ',' << row.layout.bites;
    for (const double value : {row.pressure,
                               row.cinch_tension,
                               row.layout.half_width,
                               a.organ.volume,
                               b.organ.volume,
                               a.organ.length.value_or(0),
                               b.organ.length.value_or(0),
                               a.organ.greater_curvature.value_or(0),
                               b.organ.greater_curvature.value_or(0),
                               a.organ.mean_area.value_or(0),
                               b.organ.mean_area.value_or(0),
                               a.organ.min_area.value_or(0),
                               b.organ.min_area.value_or(0),
                               a.mean_strain,
                               b.mean_strain,
                               a.high_strain,
                               b.high_strain,
                               a.mean_stress,
                               b.mean_stress,
                               a.elastic_energy,
                               b.elastic_energy,
                               row.mean_tension,
                               row.min_tension,
                               row.drawn}) {
      std::snprintf(text, sizeof text, ",%.6g", value);
      out << text;
    }
    std::snprintf(text, sizeof text, "%016" PRIx64, row.state_hash);
    out << ',' << row.torn_out << ',' << row.broken << ',' << row.loose << ',' << row.recoveries << ',' << row.crossed
        << ',' << row.at_rest << ',' << text << '\n';
  }
}

}  // namespace vibe::benchmarks
