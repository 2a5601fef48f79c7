#include <cstdio>

#include "suture/outcome_study.hpp"

namespace vibe::benchmarks {

void printOutcome(const OutcomeRow& row, std::ostream& out) {
  char line[400];
  const OrganMeasures &a = row.before.organ, &b = row.after.organ;
  std::snprintf(line, sizeof line,
                "%-14s %-2s %6d | volume %5.0f mL %6.2f %% less | length %5.2f %% | curvature %6.2f %% | area %6.2f %% "
                "least %5.1f "
                "%% | "
                "strain %4.1f to %4.1f %% | stress %4.1f to %4.1f kPa | %4.2f N least %4.2f | drawn %4.0f mm | %2.0f "
                "s, %.2f %% | "
                "%d of %d, %d torn, %d broken, %d loose%s\n",
                row.trial.name.c_str(), toString(row.trial.pattern), row.trial.particles, 1e6 * a.volume,
                percentLess(a.volume, b.volume), percentLess(a.length, b.length),
                percentLess(a.greater_curvature, b.greater_curvature), percentLess(a.mean_area, b.mean_area),
                percentLess(a.min_area, b.min_area), 100 * row.before.mean_strain, 100 * row.after.mean_strain,
                1e-3 * row.before.mean_stress, 1e-3 * row.after.mean_stress, row.mean_tension, row.min_tension,
                1e3 * row.drawn, row.settled, 100 * row.change, row.recognised, kOutcomeSets, row.torn_out, row.broken,
                row.loose, row.crossed ? ", walls CROSS" : "");
  out << line << std::flush;
}

void writeOutcomes(const std::vector<OutcomeRow>& rows, std::ostream& out) {
  out << "trial,pattern,particles,pressure,sewn_at,cinch_tension,thread_friction,foundation,volume_before,volume,"
         "length_before,length,curvature_before,curvature,area_before,area,least_area_before,least_area,strain_before,"
         "strain,stress_before,stress,mean_tension,least_tension,drawn,settled,change,recognised,torn_out,broken,loose,"
         "crossed\n";
  char text[40];
  for (const OutcomeRow& row : rows) {
    const OutcomeTrial& trial = row.trial;
    const OrganMeasures &a = row.before.organ, &b = row.after.organ;
    out << trial.name << ',' << toString(trial.pattern) << ',' << trial.particles;
    for (const double value : {trial.pressure,
                               trial.sewn_at,
                               trial.tension,
                               trial.thread_friction,
                               trial.foundation ? 1.0 : 0.0,
                               a.volume,
                               b.volume,
                               a.length.value_or(0),
                               b.length.value_or(0),
                               a.greater_curvature.value_or(0),
                               b.greater_curvature.value_or(0),
                               a.mean_area.value_or(0),
                               b.mean_area.value_or(0),
                               a.min_area.value_or(0),
                               b.min_area.value_or(0),
                               row.before.mean_strain,
                               row.after.mean_strain,
                               row.before.mean_stress,
                               row.after.mean_stress,
                               row.mean_tension,
                               row.min_tension,
                               row.drawn,
                               row.settled,
                               row.change}) {
      std::snprintf(text, sizeof text, ",%.6g", value);
      out << text;
    }
    out << ',' << row.recognised << ',' << row.torn_out << ',' << row.broken << ',' << row.loose << ','
        << (row.crossed ? 1 : 0) << '\n';
  }
}

}  // namespace vibe::benchmarks
