#include "fem/case_reader.hpp"

namespace vibe::benchmarks {
namespace {

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
                  {"angle", [&](const YamlField& f) { motion.angle = reader.number(f, "rad", -100, 100); }}});
  if ((motion.angle != 0) != (motion.axis.norm() > 0))
    source.fail(field, "has one of 'axis' and 'angle'; give both or none");
  out.motions.push_back(motion);
}

void readPull(const CaseReader& reader, const YamlField& field, FemCase& out) {
  AttachmentPull pull;
  reader.readMap(field, {"spot", "displacement"},
                 {{"spot", [&](const YamlField& f) { pull.spot = reader.source().text(f); }},
                  {"displacement", [&](const YamlField& f) { pull.displacement = reader.vector(f, "m"); }}});
  out.pulls.push_back(pull);
}

void readForce(const CaseReader& reader, const YamlField& field, FemCase& out) {
  AttachmentForce force;
  reader.readMap(field, {"spot", "force"},
                 {{"spot", [&](const YamlField& f) { force.spot = reader.source().text(f); }},
                  {"force", [&](const YamlField& f) { force.force = reader.vector(f, "N"); }}});
  out.forces.push_back(force);
}

void readCinch(const CaseReader& reader, const YamlField& field, FemCase& out) {
  Cinch cinch;
  reader.readMap(field, {"first", "second", "distance"},
                 {{"first", [&](const YamlField& f) { cinch.first = reader.source().text(f); }},
                  {"second", [&](const YamlField& f) { cinch.second = reader.source().text(f); }},
                  {"direction", [&](const YamlField& f) { cinch.direction = reader.direction(f); }},
                  {"distance", [&](const YamlField& f) { cinch.distance = reader.number(f, "m", 0, kHuge); }}});
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
                  {"volume_ratio", [&](const YamlField& f) {
                     gas.volume_ratio = reader.number(f, "1", 0.01, 100);
                     gas.by_volume = true;
                   }}});
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

}  // namespace vibe::benchmarks
