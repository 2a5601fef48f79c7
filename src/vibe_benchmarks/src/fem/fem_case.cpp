#include "fem/fem_case.hpp"

#include "fem/case_reader.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe::benchmarks {
namespace {

void readMaterial(const CaseReader& reader, const YamlField& field, FemCase& out) {
  std::vector<std::string> laws;
  for (const Choice& choice : choicesOf("tissue.law")) laws.push_back(choice.word);
  Material& m = out.material;
  reader.readMap(field, {"law", "young_modulus", "poisson_ratio"},
                 {{"law", [&](const YamlField& f) { m.law = lawByName(reader.source().choice(f, laws)); }},
                  {"young_modulus", [&](const YamlField& f) { m.young_modulus = reader.number(f, "Pa", 0, kHuge); }},
                  {"poisson_ratio", [&](const YamlField& f) { m.poisson_ratio = reader.number(f, "1", -1, 0.5); }},
                  {"stiffening", [&](const YamlField& f) { m.stiffening = reader.number(f, "1", 0, kHuge); }}});
  checkMaterial(m, reader.source().place() + ":" + std::to_string(field.line));
}

void readSpots(const CaseReader& reader, const YamlField& field, FemCase& out) {
  for (const YamlField& entry : reader.source().map(field)) {
    SpotRule& spot = out.spots[entry.key];
    reader.readMap(entry, {"centre", "radius"},
                   {{"centre", [&](const YamlField& f) { spot.centre = reader.vector(f, "m"); }},
                    {"radius", [&](const YamlField& f) { spot.radius = reader.number(f, "m", 1e-9, kHuge); }},
                    {"across", [&](const YamlField& f) { spot.along = reader.direction(f); }}});
  }
}

std::vector<std::string> names(const CaseReader& reader, const YamlField& field) {
  std::vector<std::string> found;
  reader.readList(field, [&](const YamlField& f) { found.push_back(reader.source().text(f)); });
  return found;
}

void checkElement(const CaseReader& reader, const FemCase& out) {
  const YamlField root = reader.source().root();
  const bool shell = out.element == ElementKind::Shell;
  if (shell && out.mesh.triangles.empty())
    reader.source().fail(root, "element 'shell' needs triangles; give mesh.tris or mesh.ellipsoid");
  if (!shell && out.mesh.tets.empty())
    reader.source().fail(root, "this element needs tetrahedra; give mesh.tets or mesh.box");
  if (shell && !(out.thickness > 0))
    reader.source().fail(root, "lacks the key 'thickness', which a shell needs; add it");
  if (!shell && out.gas) reader.source().fail(root, "has gas, which only element 'shell' encloses; remove 'gas'");
  if (int(out.statics.has_value()) + int(out.transient.has_value()) + int(out.modes.has_value()) != 1)
    reader.source().fail(root, "needs exactly one of the keys 'static', 'transient' and 'modes'; keep one");
}

template <class Map>
void checkName(const CaseReader& reader, const std::string& what, const std::string& name, const Map& known) {
  if (name.empty() || known.count(name) > 0) return;
  std::vector<std::string> words;
  for (const auto& entry : known) words.push_back(entry.first);
  reader.source().fail(reader.source().root(), "there is no " + what + " '" + name + "'; " + suggestKey(name, words));
}

void checkNames(const CaseReader& reader, const FemCase& out) {
  for (const auto& set : out.clamped) checkName(reader, "set", set, out.mesh.sets);
  for (const auto& set : out.hinged) checkName(reader, "set", set, out.mesh.sets);
  for (const auto& motion : out.motions) checkName(reader, "set", motion.set, out.mesh.sets);
  for (const auto& pull : out.pulls) checkName(reader, "spot", pull.spot, out.spots);
  for (const auto& force : out.forces) checkName(reader, "spot", force.spot, out.spots);
  if (out.cinch) {
    checkName(reader, "spot", out.cinch->first, out.spots);
    checkName(reader, "spot", out.cinch->second, out.spots);
  }
  for (const auto& sample : out.samples) {
    checkName(reader, "set", sample.set, out.mesh.sets);
    checkName(reader, "spot", sample.spot, out.spots);
  }
}

}  // namespace

FemCase readCase(const std::string& file) {
  const CaseReader reader(file);
  FemCase out;
  out.file = file;
  const auto number = [&](double& target, const char* unit) {
    return [&reader, &target, unit](const YamlField& f) { target = reader.number(f, unit, 0, kHuge); };
  };
  const auto runs = [&](const YamlField& f) { readRuns(reader, f, out); };
  reader.readMap(
      reader.source().root(), {"name", "mesh", "element", "material", "density", "sample"},
      {{"name", [&](const YamlField& f) { out.name = reader.source().text(f); }},
       {"source", [&](const YamlField& f) { out.source = reader.source().text(f); }},
       {"slow", [&](const YamlField& f) { out.slow = reader.source().boolean(f); }},
       {"mesh", [&](const YamlField& f) { readMesh(reader, f, out.mesh); }},
       {"element",
        [&](const YamlField& f) {
          const std::string kind = reader.source().choice(f, {"linear_tet", "quadratic_tet", "shell"});
          out.element = kind == "shell"        ? ElementKind::Shell
                        : kind == "linear_tet" ? ElementKind::LinearTet
                                               : ElementKind::QuadraticTet;
        }},
       {"refine", [&](const YamlField& f) { out.refine = static_cast<int>(reader.source().integer(f, 0, 4)); }},
       {"project", [&](const YamlField& f) { out.project = reader.vector(f, "m"); }},
       {"material", [&](const YamlField& f) { readMaterial(reader, f, out); }},
       {"density", number(out.density, "kg/m^3")},
       {"thickness", number(out.thickness, "m")},
       {"thickness_along", [&](const YamlField& f) { out.thickness_along = reader.direction(f); }},
       {"mass_damping", number(out.mass_damping, "1/s")},
       {"stiffness_damping", number(out.stiffness_damping, "s")},
       {"foundation", number(out.foundation, "N/m")},
       {"clamped", [&](const YamlField& f) { out.clamped = names(reader, f); }},
       {"hinged", [&](const YamlField& f) { out.hinged = names(reader, f); }},
       {"spots", [&](const YamlField& f) { readSpots(reader, f, out); }},
       {"loads", [&](const YamlField& f) { readLoads(reader, f, out); }},
       {"static", runs},
       {"transient", runs},
       {"modes", runs},
       {"sample", [&](const YamlField& f) { readSamples(reader, f, out); }}});
  checkElement(reader, out);
  checkNames(reader, out);
  return out;
}

}  // namespace vibe::benchmarks
