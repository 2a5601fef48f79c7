
#include "fem/case_reader.hpp"

namespace vibe::benchmarks {

namespace {

/// The key 'ramp' of a load.
CaseReader::Readers::value_type ramp(const CaseReader& reader, Ramp& out) {
  return {"ramp", [&](const YamlField& f) {
            const auto levels = reader.source().quantities(f, 2, "1", -kHuge, kHuge);
            out = {levels[0], levels[1]};
            if (!(out.from < out.to)) reader.source().fail(f, "does not rise; give two levels, for example [0, 1]");
          }};
}

void readMotion(const CaseReader& reader, const YamlField& field, FemCase& out) {
  SetMotion motion;
  const YamlSource& source = reader.source();
  reader.readMap(field, {"set"},
                 {{"set", [&](const YamlField& f) { motion.set = source.text(f); }},
                  {"held",
                   [&](const YamlField& f) {
                     motion.held = {false, false, false};
                     reader.readList(f, [&](const YamlField& axis) {
                       motion.held[static_cast<std::size_t>(source.choice(axis, {"x", "y", "z"})[0] - 'x')] = true;
                     });
                   }},
                  {"translation", [&](const YamlField& f) { motion.translation = reader.vector(f, "m"); }},
                  {"centre", [&](const YamlField& f) { motion.centre = reader.vector(f, "m"); }},
                  {"axis", [&](const YamlField& f) { motion.axis = reader.direction(f); }},
                  {"angle", [&](const YamlField& f) { motion.angle = reader.number(f, "rad", -100, 100); }},
                  ramp(reader, motion.ramp)});
  if ((motion.angle != 0) != (motion.axis.norm() > 0))
    source.fail(field, "has one of 'axis' and 'angle'; give both or none");
  out.motions.push_back(motion);
}

void readPull(const CaseReader& reader, const YamlField& field, FemCase& out) {
  AttachmentPull pull;
  reader.readMap(field, {"spot", "displacement"},
                 {{"spot", [&](const YamlField& f) { pull.spot = reader.source().text(f); }},
                  {"displacement", [&](const YamlField& f) { pull.displacement = reader.vector(f, "m"); }},
                  ramp(reader, pull.ramp)});
  out.pulls.push_back(pull);
}

void readForce(const CaseReader& reader, const YamlField& field, FemCase& out) {
  AttachmentForce force;
  reader.readMap(field, {"spot", "force"},
                 {{"spot", [&](const YamlField& f) { force.spot = reader.source().text(f); }},
                  {"force", [&](const YamlField& f) { force.force = reader.vector(f, "N"); }},
                  ramp(reader, force.ramp)});
  out.forces.push_back(force);
}

void readCinch(const CaseReader& reader, const YamlField& field, FemCase& out) {
  Cinch cinch;
  reader.readMap(field, {"first", "second", "distance"},
                 {{"first", [&](const YamlField& f) { cinch.first = reader.source().text(f); }},
                  {"second", [&](const YamlField& f) { cinch.second = reader.source().text(f); }},
                  {"direction", [&](const YamlField& f) { cinch.direction = reader.direction(f); }},
                  {"distance", [&](const YamlField& f) { cinch.distance = reader.number(f, "m", 0, kHuge); }},
                  ramp(reader, cinch.ramp)});
  out.cinch = cinch;
}

void readGas(const CaseReader& reader, const YamlField& field, FemCase& out) {
  GasRule gas;
  bool by_pressure = false;
  reader.readMap(field, {},
                 {{"pressure",
                   [&](const YamlField& f) {
                     gas.pressure = reader.number(f, "Pa", -kHuge, kHuge);
                     by_pressure = true;
                   }},
                  {"volume_ratio",
                   [&](const YamlField& f) {
                     gas.volume_ratio = reader.number(f, "1", 0.01, 100);
                     gas.by_volume = true;
                   }},
                  ramp(reader, gas.ramp)});
  if (by_pressure == gas.by_volume) reader.source().fail(field, "needs one of 'pressure' and 'volume_ratio'; give one");
  out.gas = gas;
}

}  // namespace

void readLoads(const CaseReader& reader, const YamlField& field, FemCase& out) {
  const auto each = [&](void (*read)(const CaseReader&, const YamlField&, FemCase&)) {
    return [&reader, &out, read](const YamlField& f) {
      reader.readList(f, [&](const YamlField& item) { read(reader, item, out); });
    };
  };
  reader.readMap(field, {},
                 {{"gravity", [&](const YamlField& f) { out.gravity = reader.vector(f, "m/s^2"); }},
                  {"gas", [&](const YamlField& f) { readGas(reader, f, out); }},
                  {"cinch", [&](const YamlField& f) { readCinch(reader, f, out); }},
                  {"prescribed", each(readMotion)},
                  {"pulls", each(readPull)},
                  {"forces", each(readForce)}});
}

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
