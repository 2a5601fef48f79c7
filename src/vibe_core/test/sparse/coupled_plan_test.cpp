// Plans for further pairs of nodes: the factor stays exact, and moving few nodes keeps the fill low.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <random>

#include "sparse/closed_mesh.hpp"
#include "sparse/eigen_matrix.hpp"
#include "sparse/elimination.hpp"
#include "sparse/factor_plan.hpp"

namespace vibe::coupled_plan_test {
namespace {

using test::closedMesh;
using test::ClosedMesh;

constexpr int kCuts = 14;

/// Nodes of the two caps above and below, joined as walls that touch when the sphere is squashed: each node above with
/// the three nearest below.
std::vector<NodePair> squashed(const ClosedMesh& mesh, double cap) {
  std::vector<NodePair> pairs;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].z() < cap) continue;
    std::vector<std::pair<double, int>> below;
    for (std::size_t j = 0; j < mesh.nodes.size(); ++j)
      if (mesh.nodes[j].z() < 0)
        below.emplace_back((mesh.nodes[i] - mesh.nodes[j]).head<2>().norm(), static_cast<int>(j));
    std::partial_sort(below.begin(), below.begin() + 3, below.end());
    for (int k = 0; k < 3; ++k)
      pairs.push_back({std::max(static_cast<int>(i), below[k].second), std::min(static_cast<int>(i), below[k].second)});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::int64_t nonzerosOf(const std::vector<Supernode>& supernodes) {
  std::int64_t count = 0;
  for (const Supernode& s : supernodes) {
    const auto own = static_cast<std::int64_t>(3 * s.nodes.size()),
               below = static_cast<std::int64_t>(3 * s.rows.size());
    count += own * (own + 1) / 2 + own * below;
  }
  return count;
}

struct Squashed {
  explicit Squashed(double cap = 0.9)
      : mesh(closedMesh(kCuts)),
        matrix(test::shellMatrix(mesh, 1.0, 0.1)),
        base(makeFactorPlan(matrix.pattern())),
        pairs(squashed(mesh, cap)) {}
  void couple(const std::vector<NodePair>& with) {
    matrix.couple(with);
    const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -3).normalized();
    const Eigen::Matrix3d stiffness = 50 * direction * direction.transpose();
    for (const NodePair& pair : with) {
      matrix.add(pair.row, pair.row, stiffness);
      matrix.add(pair.column, pair.column, stiffness);
      matrix.add(pair.row, pair.column, -stiffness);
    }
  }
  ClosedMesh mesh;
  BlockMatrix matrix;
  std::shared_ptr<const FactorPlan> base;
  std::vector<NodePair> pairs;
};

void expectSolves(const BlockMatrix& matrix, const std::shared_ptr<const FactorPlan>& plan, Factor& factor) {
  factor.setPlan(plan);
  ASSERT_TRUE(factor.compute(matrix));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * matrix.pattern().size, -1, 2);
  Eigen::VectorXd x(b.size()), back(b.size());
  factor.solve(b.data(), x.data());
  matrix.multiply(x.data(), back.data());
  EXPECT_LT((back - b).norm(), 1e-9 * b.norm());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> reference(test::eigenMatrix(matrix));
  EXPECT_LT((reference.solve(b) - x).norm(), 1e-8 * x.norm());
}

TEST(CoupledPlan, FactorsTheCoupledMatrixAndThePlainOneAgain) {
  Squashed world;
  Factor factor(world.base, FactorStorage::Double);
  expectSolves(world.matrix, world.base, factor);
  const BlockMatrix plain = world.matrix;
  world.couple(world.pairs);
  expectSolves(world.matrix, coupledPlan(world.base, world.pairs), factor);
  expectSolves(plain, world.base, factor);
}

TEST(CoupledPlan, AMatrixWithOtherPairsIsRejected) {
  Squashed world;
  Factor factor(coupledPlan(world.base, world.pairs));
  EXPECT_ANY_THROW(factor.compute(world.matrix));
  world.couple({world.pairs.begin(), world.pairs.end() - 1});
  EXPECT_ANY_THROW(factor.compute(world.matrix));
}

TEST(CoupledPlan, WithoutPairsItIsTheBase) {
  const Squashed world;
  EXPECT_EQ(coupledPlan(world.base, {}), world.base);
  EXPECT_NE(coupledPlan(world.base, world.pairs), world.base);
}

TEST(CoupledPlan, TheRepairedOrderIsAPermutationThatMovesFewNodes) {
  const Squashed world;
  const std::vector<int> order = repairedOrder(*world.base, world.pairs);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < static_cast<int>(sorted.size()); ++i) ASSERT_EQ(sorted[i], i);
  EXPECT_EQ(order, repairedOrder(*world.base, world.pairs));
  EXPECT_NE(order, world.base->order);
}

TEST(CoupledPlan, FillStaysNearThatOfANewOrder) {
  const Squashed world;
  const BlockPattern pattern = extended(*world.base->pattern, world.pairs);
  std::int64_t anew = 0;
  for (int seed = 1; seed < 5; ++seed) {
    const std::int64_t count = nonzerosOf(amalgamate(symbolicFactor(pattern, nestedDissection(pattern, seed))));
    anew = anew == 0 ? count : std::min(anew, count);
  }
  const std::int64_t repaired = coupledPlan(world.base, world.pairs)->nonzeros;
  const std::int64_t kept = nonzerosOf(amalgamate(symbolicFactor(pattern, world.base->order)));
  EXPECT_LT(repaired, 1.3 * static_cast<double>(anew));
  EXPECT_GT(kept, 1.1 * static_cast<double>(repaired)) << "negative control: nothing needs to move";
}

}  // namespace
}  // namespace vibe::coupled_plan_test
