// Compares the times of the sparse factor with those of CHOLMOD (supernodal), on the stiffness of a stomach and of a
// block.
#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>

#include "fem/mesh_generators.hpp"
#include "tetrahedra/tetrahedra.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/builder/tissue_registry.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/sparse/factor.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_factor [--scene FILE]\n"
    "Prints thread CPU times of the sparse Cholesky factor and of CHOLMOD: least and median of 15 repeats [ms].\n"
    "  --scene FILE      organ with tissue.model: shell (default: package://vibe_core/scenes/stomach.yaml)\n"
    "  --help            this text\n"
    "analyse: order of elimination, once per mesh; factor: once per linearization point, in the background;\n"
    "solve: several times per step; 100 cols: columns of nodes\nthat a tool touches; plan: of a factor with couplings, "
    "from the order that is there. CHOLMOD calls the BLAS of the system, which decides its times.\n";

constexpr int kRepeats = 15;  // design choice: the median of this many runs is reproducible to a few percent

/// The wall of the organ of a scene with tissue.model: shell.
ElasticBody stomachBody(const std::string& scene_file) {
  Scene scene = loadScene(scene_file);
  scene.scope.reset(), scene.helix.reset(), scene.suture.reset(), scene.bleeding.reset(), scene.marking.reset();
  return wallBody(*buildModel(scene, ""));
}

/// A block of linear tetrahedra of 10 mm, held at one end.
ElasticBody blockBody(const std::array<int, 3>& cells) {
  const benchmarks::BenchMesh mesh =
      benchmarks::makeBox(Eigen::Vector3d::Zero(), 0.01 * Eigen::Vector3d(cells[0], cells[1], cells[2]), cells, 6);
  const auto elements = std::make_shared<const benchmarks::TetElements<4>>(
      benchmarks::TetMesh<4>{mesh.nodes, mesh.tets, {{Law::NeoHookean, 3e4, 0.45, 0}}, {}});
  ElasticBody body;
  body.elements = elements;
  body.rest = mesh.nodes;
  body.mass = elements->lumpedMass(1000);
  for (const Eigen::Vector3d& p : mesh.nodes) body.fixed.push_back(p.x() < 1e-9 ? 1 : 0);
  return body;
}

/// Stiffness at rest with the inertia of a step of 1/60 s, as the implicit solver factors it.
BlockMatrix stiffnessOf(const ElasticBody& body) {
  constexpr double kInertia = 3600;  // [1/s^2]
  BlockMatrix matrix(std::make_shared<BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups())));
  const std::vector<double> displacement(3 * body.rest.size(), 0.0);
  body.elements->addStiffness(displacement.data(), matrix);
  for (int n = 0; n < body.nodeCount(); ++n) {
    const double spring = body.foundation.empty() ? 0 : body.foundation[n];
    matrix.add(n, n, (kInertia * body.mass[n] + spring) * Eigen::Matrix3d::Identity());
  }
  for (int n = 0; n < body.nodeCount(); ++n)
    if (body.fixed[n] != 0) matrix.fix(n);
  return matrix;
}

/// The same for other solvers, both triangles.
Eigen::SparseMatrix<double> eigenMatrix(const BlockMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto put = [&](int row, int column, const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
  };
  const BlockPattern& pattern = matrix.pattern();
  for (int i = 0; i < pattern.size; ++i) {
    put(i, i, matrix.diagonal()[i]);
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
      put(i, pattern.column[k], matrix.lower()[k]);
      put(pattern.column[k], i, matrix.lower()[k].transpose());
    }
  }
  Eigen::SparseMatrix<double> result(3 * pattern.size, 3 * pattern.size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void print(const std::string& matrix, const std::string& method, const std::string& part,
           const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const double begin = threadCpuTime();
    work();
    times.push_back(1e3 * (threadCpuTime() - begin));
  }
  std::sort(times.begin(), times.end());
  std::printf("%-8s %-14s %-8s %9.3f %9.3f\n", matrix.c_str(), method.c_str(), part.c_str(), times.front(),
              times[kRepeats / 2]);
}

void solve(const Factor& factor, std::vector<float>& nodes4, std::vector<float>& vector) {
  factor.load(nodes4.data(), vector.data());
  factor.forward(vector.data());
  factor.backward(vector.data());
  factor.store(vector.data(), nodes4.data());
}

void printOwn(const std::string& name, const BlockMatrix& matrix) {
  std::shared_ptr<const FactorPlan> plan;
  print(name, "vibe", "analyse", [&] { plan = makeFactorPlan(matrix.pattern()); });
  for (const auto& [storage, method] :
       {std::pair(FactorStorage::Half, "vibe half"), std::pair(FactorStorage::Float, "vibe float")}) {
    Factor factor(plan, storage);
    print(name, method, "factor", [&] { factor.compute(matrix); });
    std::vector<float> nodes4(4 * static_cast<std::size_t>(matrix.pattern().size), 1.0F);
    std::vector<float> vector(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
    print(name, method, "solve", [&] {
      std::fill(nodes4.begin(), nodes4.end(), 1.0F);
      solve(factor, nodes4, vector);
    });
  }
}

// Nodes of the front wall coupled with the nearest ones of the back wall, as where the walls of an empty organ touch.
std::vector<NodePair> touchingWalls(const ElasticBody& body, const BlockPattern& pattern, std::size_t touching) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : body.rest) centre += p / static_cast<double>(body.rest.size());
  std::vector<std::pair<double, int>> front, back;
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    if (body.fixed[i] != 0) continue;
    const Eigen::Vector3d from = body.rest[i] - centre;
    (from.x() > 0 ? front : back).emplace_back(from.tail<2>().norm(), static_cast<int>(i));
  }
  std::sort(front.begin(), front.end());
  front.resize(std::min(touching, front.size()));
  std::vector<NodePair> pairs;
  for (const auto& near : front) {
    for (auto& [distance, node] : back) distance = (body.rest[node] - body.rest[near.second]).tail<2>().norm();
    std::partial_sort(back.begin(), back.begin() + 3, back.end());
    for (int k = 0; k < 3; ++k) {
      const NodePair pair{std::max(near.second, back[k].second), std::min(near.second, back[k].second)};
      if (pattern.find(pair.row, pair.column) < 0) pairs.push_back(pair);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void printCoupled(const ElasticBody& body, BlockMatrix matrix) {
  const auto base = makeFactorPlan(matrix.pattern());
  for (const std::size_t touching : {30, 100, 300}) {
    const std::string name = std::to_string(touching) + " touch";
    const std::vector<NodePair> pairs = touchingWalls(body, matrix.pattern(), touching);
    std::shared_ptr<const FactorPlan> plan;
    print(name, "vibe half", "plan", [&] { plan = coupledPlan(base, pairs); });
    matrix.couple(pairs);
    Factor factor(plan), plain(base);
    print(name, "vibe half", "factor", [&] { factor.compute(matrix); });
    std::vector<float> nodes4(4 * body.rest.size(), 1.0F), vector(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
    print(name, "vibe half", "solve", [&] {
      std::fill(nodes4.begin(), nodes4.end(), 1.0F);
      solve(factor, nodes4, vector);
    });
    std::printf("# %zu pairs: %.2f million numbers in the factor, without them %.2f\n", pairs.size(),
                1e-6 * static_cast<double>(factor.nonzeros()), 1e-6 * static_cast<double>(plain.nonzeros()));
  }
}

void printAssembly(const std::string& name, const ElasticBody& body) {
  BlockMatrix matrix(std::make_shared<BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups())));
  const std::vector<double> displacement(3 * body.rest.size(), 0.0);
  print(name, "vibe", "assembly", [&] {
    matrix.setZero();
    body.elements->addStiffness(displacement.data(), matrix);
  });
}

// Columns of a hundred nodes that lie next to each other, as those under a tool.
void printColumns(const std::string& name, const ElasticBody& body, const Factor& factor) {
  std::vector<std::pair<double, int>> nodes;
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    nodes.emplace_back((body.rest[i] - body.rest[body.rest.size() / 2]).norm(), static_cast<int>(i));
  std::sort(nodes.begin(), nodes.end());
  std::vector<HalfColumns> columns(100);
  print(name, "vibe half", "100 cols", [&] {
    for (std::size_t k = 0; k < columns.size(); ++k) factor.halfColumns(nodes[k].second, columns[k]);
  });
}

void printCholmod(const std::string& name, const BlockMatrix& matrix) {
  const Eigen::SparseMatrix<double> a = eigenMatrix(matrix);
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholmod;
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(a.rows());
  Eigen::VectorXd x = b;
  print(name, "CHOLMOD double", "analyse", [&] { cholmod.analyzePattern(a); });
  print(name, "CHOLMOD double", "factor", [&] { cholmod.factorize(a); });
  print(name, "CHOLMOD double", "solve", [&] { x = cholmod.solve(b); });
}

void printTable(const std::string& scene) {
  std::printf("%-8s %-14s %-8s %9s %9s\n", "matrix", "method", "part", "least", "median");
  for (const auto& [name, body] : {std::pair<std::string, ElasticBody>("stomach", stomachBody(scene)),
                                   std::pair<std::string, ElasticBody>("block", blockBody({14, 10, 8}))}) {
    const BlockMatrix matrix = stiffnessOf(body);
    std::printf("# %s: %d nodes\n", name.c_str(), matrix.pattern().size);
    printAssembly(name, body);
    printOwn(name, matrix);
    Factor factor(makeFactorPlan(matrix.pattern()));
    factor.compute(matrix);
    printColumns(name, body, factor);
    if (name == "stomach") printCoupled(body, matrix);
    printCholmod(name, matrix);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::string scene = "package://vibe_core/scenes/stomach.yaml";
    for (int i = 1; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--help") return std::fputs(kHelp, stdout), 0;
      if (option != "--scene" || i + 1 == argc)
        throw Error("'" + option + "' is no option of vibe_factor; see --help.");
      scene = argv[++i];
    }
    printTable(resolveAddress(scene));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_factor: %s\n", error.what());
    return 2;
  }
  return 0;
}
