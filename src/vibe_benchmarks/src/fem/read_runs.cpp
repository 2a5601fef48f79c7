#include <cmath>

#include "fem/case_reader.hpp"

namespace vibe::benchmarks {
namespace {

void readStatic(const CaseReader& reader, const YamlField& field, FemCase& out) {
  StaticRun run;
  reader.readMap(
      field, {"levels"},
      {{"levels",
        [&](const YamlField& f) {
          reader.readList(
              f, [&](const YamlField& level) { run.levels.push_back(reader.number(level, "1", -kHuge, kHuge)); });
          if (run.levels.empty()) reader.source().fail(f, "is empty; give at least one level, for example [1]");
        }},
       {"substeps", [&](const YamlField& f) { run.substeps = static_cast<int>(reader.source().integer(f, 1, 10000)); }},
       {"tolerance", [&](const YamlField& f) { run.tolerance = reader.number(f, "m", 1e-15, 1); }}});
  out.statics = run;
}

void readStart(const CaseReader& reader, const YamlField& field, TransientRun& run) {
  reader.readMap(
      field, {},
      {{"level",
        [&](const YamlField& f) {
          run.start_at_equilibrium = true;
          run.start_level = reader.number(f, "1", -kHuge, kHuge);
        }},
       {"mode", [&](const YamlField& f) { run.start_mode = static_cast<int>(reader.source().integer(f, 1, 50)); }},
       {"amplitude", [&](const YamlField& f) { run.start_amplitude = reader.number(f, "m", 0, kHuge); }}});
  if (run.start_at_equilibrium == (run.start_mode > 0) || (run.start_mode > 0) != (run.start_amplitude > 0))
    reader.source().fail(field, "needs either 'level' or both 'mode' and 'amplitude'; give those");
}

void readPath(const CaseReader& reader, const YamlField& field, TransientRun& run) {
  reader.readList(field, [&](const YamlField& f) {
    const auto pair = reader.source().quantities(f, 2, "1", -kHuge, kHuge);
    if (!run.path.empty() && pair[0] < run.path.back()[0]) reader.source().fail(f, "goes back in time; sort by time");
    run.path.push_back({pair[0], pair[1]});
  });
}

void readTransient(const CaseReader& reader, const YamlField& field, FemCase& out) {
  TransientRun run;
  const YamlSource& source = reader.source();
  reader.readMap(
      field, {"step", "duration"},
      {{"step", [&](const YamlField& f) { run.step = reader.number(f, "s", 1e-7, 1); }},
       {"duration", [&](const YamlField& f) { run.duration = reader.number(f, "s", 1e-7, 1e4); }},
       {"spectral_radius", [&](const YamlField& f) { run.spectral_radius = reader.number(f, "1", 0, 1); }},
       {"backward_euler", [&](const YamlField& f) { run.backward_euler = source.boolean(f); }},
       {"iterations", [&](const YamlField& f) { run.iterations = static_cast<int>(source.integer(f, 1, 10000)); }},
       {"tolerance", [&](const YamlField& f) { run.tolerance = reader.number(f, "m", 0, 1); }},
       {"refactor_interval", [&](const YamlField& f) { run.refactor_interval = reader.number(f, "s", 0, 1e4); }},
       {"start", [&](const YamlField& f) { readStart(reader, f, run); }},
       {"path", [&](const YamlField& f) { readPath(reader, f, run); }}});
  if (run.duration < run.step || run.duration / run.step > 1e6)
    source.fail(field, "has a duration that is not between one and a million steps; change 'step' or 'duration'");
  out.transient = run;
}

}  // namespace

void readRuns(const CaseReader& reader, const YamlField& field, FemCase& out) {
  if (field.key == "static") return readStatic(reader, field, out);
  if (field.key == "transient") return readTransient(reader, field, out);
  ModesRun run;
  reader.readMap(
      field, {"count"},
      {{"count", [&](const YamlField& f) { run.count = static_cast<int>(reader.source().integer(f, 1, 50)); }}});
  out.modes = run;
}

}  // namespace vibe::benchmarks
