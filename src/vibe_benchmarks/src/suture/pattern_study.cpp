#include "suture/pattern_study.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "suture/suture_session.hpp"
#include "vibe_core/files/files.hpp"

namespace vibe::benchmarks {

namespace {

constexpr double kLongestWait = 10;  // [s]
constexpr double kLoaded = 15 * kMillimetreOfMercury;

double meanStress(const Model& model, const State& state) {
  const std::size_t n = state.x.size();
  std::vector<double> fx(n, 0.0), fy(n, 0.0), fz(n, 0.0);
  model.tissue->addForces(state, fx.data(), fy.data(), fz.data());
  const auto mean = [&](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0) / double(n); };
  const double cx = mean(state.x), cy = mean(state.y), cz = mean(state.z);
  double virial = 0, wall = 0;
  for (std::size_t i = 0; i < n; ++i) {
    virial += fx[i] * (state.x[i] - cx) + fy[i] * (state.y[i] - cy) + fz[i] * (state.z[i] - cz);
    wall += model.area[i] * model.organ.thickness[i];
  }
  return -0.5 * virial / wall;
}

void measureStrain(const Model& model, const State& state, PatternMeasures& measures) {
  std::vector<float> strain(state.x.size());
  model.tissue->strain(state, strain.data());
  std::vector<std::pair<double, double>> sorted;  // strain, area
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < strain.size(); ++i) {
    sorted.emplace_back(strain[i], model.area[i]);
    sum += model.area[i] * static_cast<double>(strain[i]);
    area += model.area[i];
  }
  measures.mean_strain = sum / area;
  std::sort(sorted.begin(), sorted.end());
  double above = area;
  for (const auto& [value, share] : sorted) {
    above -= share;
    measures.high_strain = value;
    if (above <= 0.05 * area) break;
  }
}

}  // namespace

PatternMeasures measurePattern(const SutureSession& session, OrganRuler& ruler) {
  const Model& model = session.model();
  const State& state = session.state();
  PatternMeasures measures;
  measures.organ = ruler.measure(state.x, state.y, state.z);
  measureStrain(model, state, measures);
  measures.mean_stress = meanStress(model, state);
  measures.elastic_energy = model.tissue->energy(state);
  return measures;
}

namespace {

void noteTensions(const State& state, PatternRow& row) {
  std::vector<double> tensions;
  for (const Suture& suture : state.procedure.sutures)
    tensions.push_back(suture.tension.empty() ? 0 : suture.tension.front());
  row.min_tension = *std::min_element(tensions.begin(), tensions.end());
  row.mean_tension = std::accumulate(tensions.begin(), tensions.end(), 0.0) / static_cast<double>(tensions.size());
}

void noteSet(const SewnSet& set, PatternRow& row) {
  row.drawn += set.drawn;
  row.torn_out += set.tear_outs;
  row.broken += set.breaks;
  row.loose += set.loose;
  row.recoveries += set.recoveries;
}

SetLayout layoutOf(const char* pattern, double half_width) {
  SetLayout layout;
  layout.pattern = pattern;
  layout.half_width = half_width;
  return layout;
}

}  // namespace

PatternRow runPattern(Scene scene, const SetLayout& layout, double pressure, double cinch_tension) {
  scene.gas->regulated_pressure = pressure;
  scene.suture->cinch_tension = cinch_tension;
  const auto model = buildModel(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"));
  PatternRow row;
  row.layout = layout;
  row.pressure = pressure;
  row.cinch_tension = cinch_tension;
  OrganRuler ruler(model->organ);
  SutureSession session(model);
  session.settle();
  row.before = measurePattern(session, ruler);
  for (const auto& set : planSets(WallPlan(model->organ, session.wall()), layout)) noteSet(session.sew(set, 0.5), row);
  row.at_rest = session.calmDown(kLongestWait);
  row.after = measurePattern(session, ruler);
  noteTensions(session.state(), row);
  row.crossed = wallsCross(session.model(), session.state());
  row.state_hash = hash(session.state());
  return row;
}

std::vector<PatternRow> studyPatterns(const Scene& scene, bool quick, std::ostream& log) {
  std::vector<PatternRow> rows;
  const auto run = [&](const SetLayout& layout, double pressure, double tension) {
    rows.push_back(runPattern(scene, layout, pressure, tension));
    printPatterns({rows.back()}, log);
    log << std::flush;
  };
  const double tension = scene.suture->cinch_tension, half_width = SetLayout().half_width;
  for (const char* pattern : {"c", "u", "z"}) run(layoutOf(pattern, half_width), kLoaded, tension);
  if (quick) return rows;
  for (const double width : {half_width, 2 * half_width})
    run(layoutOf("u", width), scene.gas->regulated_pressure, tension);
  for (const double other : {2.0, 4.0})
    for (const char* pattern : {"c", "u", "z"}) run(layoutOf(pattern, half_width), kLoaded, other);
  for (const char* pattern : {"c", "u", "z"}) run(layoutOf(pattern, 1.5 * half_width), kLoaded, tension);
  return rows;
}

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
