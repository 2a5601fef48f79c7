#include "fem/case_model.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe::benchmarks {
namespace {

/// The hinged sides between two nodes; the wall rotates freely about them.
std::vector<std::array<int, 2>> hingedSides(const FemCase& bench_case, const BenchMesh& mesh) {
  std::vector<char> hinged(mesh.nodes.size(), 0);
  for (const std::string& name : bench_case.hinged)
    for (const int node : mesh.sets.at(name)) hinged[node] = 1;
  std::map<std::array<int, 2>, int> sides;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
      if (hinged[a] != 0 && hinged[b] != 0) sides[{std::min(a, b), std::max(a, b)}] = 1;
    }
  std::vector<std::array<int, 2>> list;
  for (const auto& side : sides) list.push_back(side.first);
  return list;
}

}  // namespace

void buildShell(const FemCase& bench_case, const BenchMesh& mesh, ElasticBody& body) {
  ShellMesh shell;
  shell.nodes = mesh.nodes;
  shell.triangles = mesh.triangles;
  shell.thickness.assign(mesh.triangles.size(), bench_case.thickness);
  shell.materials = {bench_case.material};
  shell.fixed.assign(mesh.nodes.size(), 0);
  for (const auto* names : {&bench_case.clamped, &bench_case.hinged})
    for (const std::string& name : *names)
      for (const int node : mesh.sets.at(name)) shell.fixed[node] = 1;
  for (const SetMotion& motion : bench_case.motions)
    if (motion.held[0] && motion.held[1] && motion.held[2])
      for (const int node : mesh.sets.at(motion.set)) shell.fixed[node] = 1;
  shell.hinged = hingedSides(bench_case, mesh);
  auto elements = std::make_shared<ShellElements>(std::move(shell));
  body.shell = elements.get();
  body.mass = elements->lumpedMass(bench_case.density);
  body.elements = std::move(elements);
}

}  // namespace vibe::benchmarks
