#include "fem/case_reader.hpp"

namespace vibe::benchmarks {
namespace {

const std::vector<std::string>& kindNames() {
  static const std::vector<std::string> names = {"reaction", "torque",   "displacement",   "spot_force", "tension",
                                                 "volume",   "pressure", "limit_pressure", "profile",    "frequency",
                                                 "kept",     "series",   "static_field"};
  return names;
}

struct Needs {
  bool set = false, spot = false, where = false, direction = false, table = false;
};

Needs needsOf(const Sample& sample, bool modes) {
  Needs needs;
  const SampleKind k = sample.kind;
  needs.set = k == SampleKind::Reaction || k == SampleKind::Torque;
  needs.spot = k == SampleKind::AttachmentForce;
  needs.where = k == SampleKind::Displacement || k == SampleKind::Series || k == SampleKind::Kept ||
                (k == SampleKind::Frequency && !modes);
  needs.direction = needs.set || needs.spot || needs.where;
  needs.table = k == SampleKind::Profile || k == SampleKind::Series || k == SampleKind::StaticField;
  return needs;
}

void check(const CaseReader& reader, const YamlField& field, const Sample& sample, bool modes) {
  const Needs needs = needsOf(sample, modes);
  const auto need = [&](bool lacks, const std::string& key) {
    if (lacks) reader.source().fail(field, "of this kind needs " + key + "; add it");
  };
  need(needs.set && sample.set.empty(), "'set'");
  need(needs.spot && sample.spot.empty(), "'spot'");
  need(needs.where && sample.set.empty() && sample.points.empty(), "'set' or 'points'");
  need(needs.direction && !(sample.direction.norm() > 0), "'direction'");
  need(needs.table && sample.table.empty(), "'table'");
  need(sample.kind == SampleKind::Series && sample.column.empty(), "'column'");
  need(sample.kind == SampleKind::Frequency && modes && sample.mode == 0, "'mode'");
}

void readReference(const CaseReader& reader, const YamlField& field, Sample& sample) {
  const auto one = [&](const YamlField& f) {
    const bool none = f.value.IsNull() || (f.value.IsScalar() && f.value.Scalar() == "none");
    sample.reference.push_back(none ? std::nullopt : std::optional<double>(reader.number(f, "1", -1e300, 1e300)));
  };
  if (field.value.IsSequence())
    reader.readList(field, one);
  else
    one(field);
}

}  // namespace

void readSamples(const CaseReader& reader, const YamlField& field, FemCase& out) {
  const YamlSource& source = reader.source();
  // 'modes' may follow 'sample' in the file
  bool modes = false;
  for (const YamlField& entry : source.map(source.root())) modes |= entry.key == "modes";
  reader.readList(field, [&](const YamlField& item) {
    Sample sample;
    const auto vector = [&](Eigen::Vector3d& target) {
      return [&reader, &target](const YamlField& f) { target = reader.vector(f, "m"); };
    };
    reader.readMap(item, {"name", "kind"},
                   {{"name", [&](const YamlField& f) { sample.name = source.text(f); }},
                    {"kind",
                     [&](const YamlField& f) {
                       const std::string kind = source.choice(f, kindNames());
                       for (std::size_t i = 0; i < kindNames().size(); ++i)
                         if (kindNames()[i] == kind) sample.kind = static_cast<SampleKind>(i);
                     }},
                    {"set", [&](const YamlField& f) { sample.set = source.text(f); }},
                    {"spot", [&](const YamlField& f) { sample.spot = source.text(f); }},
                    {"points",
                     [&](const YamlField& f) {
                       reader.readList(
                           f, [&](const YamlField& point) { sample.points.push_back(reader.vector(point, "m")); });
                     }},
                    {"direction", [&](const YamlField& f) { sample.direction = reader.direction(f); }},
                    {"centre", vector(sample.centre)},
                    {"mode", [&](const YamlField& f) { sample.mode = static_cast<int>(source.integer(f, 1, 50)); }},
                    {"rest_volume", [&](const YamlField& f) { sample.rest_volume = reader.number(f, "m^3", 0, 1e12); }},
                    {"until", [&](const YamlField& f) { sample.until = reader.number(f, "s", 0, 1e12); }},
                    {"table", [&](const YamlField& f) { sample.table = reader.path(f); }},
                    {"column", [&](const YamlField& f) { sample.column = source.text(f); }},
                    {"reference", [&](const YamlField& f) { readReference(reader, f, sample); }}});
    check(reader, item, sample, modes);
    out.samples.push_back(sample);
  });
}

}  // namespace vibe::benchmarks
