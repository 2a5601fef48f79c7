#include "fem/case_reader.hpp"

#include <cmath>

#include "fem/bench_mesh.hpp"

namespace vibe::benchmarks {

CaseReader::CaseReader(const std::string& file)
    : source_(YamlSource::load(file, YamlLimits{})),
      folder_(file.find('/') == std::string::npos ? "" : file.substr(0, file.rfind('/') + 1)) {}

void CaseReader::readMap(const YamlField& field, const std::vector<std::string>& needed, const Readers& readers) const {
  std::vector<std::string> known;
  for (const auto& reader : readers) known.push_back(reader.first);
  const std::vector<YamlField> entries = source_.map(field, known, needed);
  for (const YamlField& entry : entries) readers.at(entry.key)(entry);
}

void CaseReader::readList(const YamlField& field, const std::function<void(const YamlField&)>& reader) const {
  for (const YamlField& item : source_.list(field)) reader(item);
}

double CaseReader::number(const YamlField& field, const std::string& unit, double low, double high) const {
  return source_.quantity(field, unit, low, high);
}

Eigen::Vector3d CaseReader::vector(const YamlField& field, const std::string& unit) const {
  const auto values = source_.quantities(field, 3, unit, -1e12, 1e12);
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d CaseReader::direction(const YamlField& field) const {
  const Eigen::Vector3d given = vector(field, "1");
  if (!(given.norm() > 0)) source_.fail(field, "has length 0; give a direction");
  return given.normalized();
}

std::string CaseReader::path(const YamlField& field) const {
  const std::string given = source_.text(field);
  return given[0] == '/' ? given : folder_ + given;
}

namespace {

void readBox(const CaseReader& reader, const YamlField& field, BenchMesh& mesh) {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), size = origin, cells = origin;
  int tets = 6;
  reader.readMap(
      field, {"size", "cells"},
      {{"origin", [&](const YamlField& f) { origin = reader.vector(f, "m"); }},
       {"size", [&](const YamlField& f) { size = reader.vector(f, "m"); }},
       {"cells",
        [&](const YamlField& f) {
          cells = reader.vector(f, "1");
          if (cells != cells.array().round().matrix() || cells.minCoeff() < 1 || cells.prod() > 1e6)
            reader.source().fail(f,
                                 "needs three whole numbers above 0 with a product up to a million; "
                                 "write for example [24, 6, 6]");
        }},
       {"tets_per_cell", [&](const YamlField& f) { tets = static_cast<int>(reader.source().integer(f, 5, 6)); }}});
  mesh =
      makeBox(origin, size, {static_cast<int>(cells[0]), static_cast<int>(cells[1]), static_cast<int>(cells[2])}, tets);
}

void readEllipsoid(const CaseReader& reader, const YamlField& field, BenchMesh& mesh) {
  double radius = 0, half_length = 0, edge = 0, pole_edge = 0;
  int nodes = 0;
  reader.readMap(
      field, {"radius", "half_length"},
      {{"radius", [&](const YamlField& f) { radius = reader.number(f, "m", 1e-9, 1e9); }},
       {"half_length", [&](const YamlField& f) { half_length = reader.number(f, "m", 1e-9, 1e9); }},
       {"nodes", [&](const YamlField& f) { nodes = static_cast<int>(reader.source().integer(f, 14, 1000000)); }},
       {"edge", [&](const YamlField& f) { edge = reader.number(f, "m", 1e-9, 1e9); }},
       {"pole_edge", [&](const YamlField& f) { pole_edge = reader.number(f, "m", 1e-9, 1e9); }}});
  if ((nodes > 0) == (edge > 0 && pole_edge > 0))
    reader.source().fail(field, "needs either 'nodes' or both 'edge' and 'pole_edge'; give those");
  mesh =
      nodes > 0 ? makeEllipsoid(radius, half_length, nodes) : makeGradedEllipsoid(radius, half_length, edge, pole_edge);
}

void readCylinder(const CaseReader& reader, const YamlField& field, BenchMesh& mesh) {
  double radius = 0, height = 0;
  int rings = 0, layers = 0;
  const auto count = [&reader](int& target) {
    return [&reader, &target](const YamlField& f) { target = static_cast<int>(reader.source().integer(f, 1, 200)); };
  };
  reader.readMap(field, {"radius", "height", "rings", "layers"},
                 {{"radius", [&](const YamlField& f) { radius = reader.number(f, "m", 1e-9, 1e9); }},
                  {"height", [&](const YamlField& f) { height = reader.number(f, "m", 1e-9, 1e9); }},
                  {"rings", count(rings)},
                  {"layers", count(layers)}});
  mesh = makeCylinder(radius, height, rings, layers);
}

/// The nodes of a set given by a box in space, or the node nearest to a point.
void readSet(const CaseReader& reader, const YamlField& field, BenchMesh& mesh) {
  const double far = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(-far), high = Eigen::Vector3d::Constant(far), near;
  bool nearest = false;
  reader.readMap(field, {},
                 {{"min", [&](const YamlField& f) { low = reader.vector(f, "m"); }},
                  {"max", [&](const YamlField& f) { high = reader.vector(f, "m"); }},
                  {"nearest", [&](const YamlField& f) {
                     near = reader.vector(f, "m");
                     nearest = true;
                   }}});
  std::vector<int>& set = mesh.sets[field.key];
  set.clear();
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    if (!nearest && (mesh.nodes[n].array() >= low.array()).all() && (mesh.nodes[n].array() <= high.array()).all())
      set.push_back(n);
    if (nearest && (set.empty() || (mesh.nodes[n] - near).norm() < (mesh.nodes[set[0]] - near).norm()))
      set.assign(1, n);
  }
  if (set.empty()) reader.source().fail(field, "has no node; widen its box");
}

}  // namespace

void readMesh(const CaseReader& reader, const YamlField& field, BenchMesh& mesh) {
  std::string tets, tris, sets;
  std::vector<YamlField> named;
  reader.readMap(field, {},
                 {{"box", [&](const YamlField& f) { readBox(reader, f, mesh); }},
                  {"ellipsoid", [&](const YamlField& f) { readEllipsoid(reader, f, mesh); }},
                  {"cylinder", [&](const YamlField& f) { readCylinder(reader, f, mesh); }},
                  {"nodes", [&](const YamlField& f) { mesh.nodes = readNodes(reader.path(f)); }},
                  {"tets", [&](const YamlField& f) { tets = reader.path(f); }},
                  {"tris", [&](const YamlField& f) { tris = reader.path(f); }},
                  {"sets", [&](const YamlField& f) { sets = reader.path(f); }},
                  {"named", [&](const YamlField& f) {
                     for (const YamlField& entry : reader.source().map(f)) named.push_back(entry);
                   }}});
  const int count = static_cast<int>(mesh.nodes.size());
  if (count == 0)
    reader.source().fail(field, "has no nodes; give 'nodes' with 'tets' or 'tris', 'box', 'cylinder' or 'ellipsoid'");
  if (!tets.empty()) {
    const auto numbers = readElements(tets, 4, count);
    for (std::size_t i = 0; i < numbers.size(); i += 4)
      mesh.tets.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
  }
  if (!tris.empty()) {
    const auto numbers = readElements(tris, 3, count);
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      mesh.triangles.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  if (!sets.empty())
    for (const auto& set : readSets(sets, count)) mesh.sets[set.first] = set.second;
  for (const YamlField& set : named) readSet(reader, set, mesh);
  if (mesh.tets.empty() == mesh.triangles.empty())
    reader.source().fail(field, "needs either tetrahedra or triangles; give one of 'tets' and 'tris'");
}

}  // namespace vibe::benchmarks
