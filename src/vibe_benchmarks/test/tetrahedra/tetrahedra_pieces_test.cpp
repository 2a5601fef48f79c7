#include <gtest/gtest.h>

#include <thread>

#include "tetrahedra/tetrahedra_worlds.hpp"

namespace vibe::benchmarks::tetrahedra_pieces_test {
namespace {

using namespace test;

TEST(TetrahedraInPieces, SingleIsDouble) {
  forAllElements(
      [](const ElasticElements& elements, const auto&) {
        for (const double amount : {1e-6, 1e-3, 0.1}) {
          const Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), amount * kSide);
          const TetEvaluation d = inDouble(elements, u), f = inSingle(elements, u);
          EXPECT_LT((d.gradient - f.gradient).norm(), 1e-5 * d.gradient.norm()) << amount;
          EXPECT_NEAR(f.energy, d.energy, 1e-5 * d.energy) << amount;
        }
      },
      {2, 2, 1});
}

// The outputs of all pieces, each of its own, one after another.
std::vector<double> outputs(const ElasticElements& elements, const std::vector<float>& u, int threads) {
  const int pieces = elements.pieceCount();
  std::vector<std::vector<float>> gradient(static_cast<std::size_t>(pieces), std::vector<float>(u.size(), 0.0f));
  std::vector<double> energy(static_cast<std::size_t>(pieces));
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t)
    pool.emplace_back([&, t] {
      for (int piece = pieces - 1 - t; piece >= 0; piece -= threads) {
        const auto p = static_cast<std::size_t>(piece);
        energy[p] = elements.evaluate(piece, u.data(), gradient[p].data());
      }
    });
  for (auto& thread : pool) thread.join();
  for (const auto& part : gradient) energy.insert(energy.end(), part.begin(), part.end());
  return energy;
}

TEST(TetrahedraInPieces, PiecesDependOnNoThread) {
  const TetElements<4> elements(linearMesh(Law::NeoHookean, {9, 7, 6}));
  ASSERT_EQ(elements.pieceCount(), 8);
  const Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), 0.1 * kSide);
  const std::vector<float> in = fourFloats(u);
  const std::vector<double> alone = outputs(elements, in, 1);
  EXPECT_EQ(alone, outputs(elements, in, 3));
  EXPECT_EQ(alone, outputs(elements, in, 8));
  const TetEvaluation whole = inDouble(elements, u);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(u.size());
  for (std::size_t k = 8; k < alone.size(); ++k) {
    const std::size_t number = (k - 8) % in.size();
    if (number % 4 < 3) sum[static_cast<Eigen::Index>(number / 4 * 3 + number % 4)] += alone[k];
  }
  EXPECT_LT((sum - whole.gradient).norm(), 1e-5 * whole.gradient.norm());
}

TEST(TetrahedraInPieces, SeveralMaterialsAreTheSumOfTheirParts) {
  TetMesh<4> mesh = linearMesh(Law::NeoHookean, {3, 2, 2});
  mesh.materials = {material(Law::NeoHookean), {Law::Fung, 5e4, 0.4, 1.2}, {Law::NeoHookean, 9e4, 0.3, 0}};
  std::array<TetMesh<4>, 3> parts;
  for (std::size_t m = 0; m < 3; ++m) parts[m].nodes = mesh.nodes, parts[m].materials = {mesh.materials[m]};
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    mesh.material.push_back(static_cast<int>(e * 7 % 3));
    parts[e * 7 % 3].elements.push_back(mesh.elements[e]);
  }
  const TetElements<4> whole(mesh);
  const Eigen::VectorXd u = randomDisplacement(whole.nodeCount(), 0.1 * kSide);
  double energy = 0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(u.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(u.size(), u.size());
  for (const auto& part : parts) {
    const TetElements<4> elements(part);
    const TetEvaluation e = inDouble(elements, u);
    energy += e.energy, gradient += e.gradient, stiffness += denseStiffness(elements, u);
  }
  const TetEvaluation ours = inSingle(whole, u);
  EXPECT_NEAR(ours.energy, energy, 1e-5 * energy);
  EXPECT_LT((ours.gradient - gradient).norm(), 1e-5 * gradient.norm());
  EXPECT_LT((denseStiffness(whole, u) - stiffness).norm(), 1e-12 * stiffness.norm());
}

TEST(TetrahedraInPieces, GarbageHasFiniteEnergyAndForce) {
  const double metre_per_side = 1 / kSide;
  forAllElements([&](const ElasticElements& elements, const std::vector<Eigen::Vector3d>& nodes) {
    for (const double amount : {1.0, 30.0, 10 * metre_per_side}) {
      const TetEvaluation e = inSingle(elements, randomDisplacement(elements.nodeCount(), amount * kSide));
      EXPECT_TRUE(std::isfinite(e.energy) && e.gradient.allFinite()) << amount;
    }
    for (const Eigen::Vector3d& f : {Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 0, 0),
                                     Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(3, 3, 3)}) {
      Eigen::VectorXd u(3 * elements.nodeCount());
      for (std::size_t i = 0; i < nodes.size(); ++i)
        u.segment<3>(3 * static_cast<Eigen::Index>(i)) = f.cwiseProduct(nodes[i]) - nodes[i];
      const TetEvaluation e = inSingle(elements, u);
      EXPECT_TRUE(std::isfinite(e.energy) && e.gradient.allFinite()) << f.transpose();
      EXPECT_TRUE(denseStiffness(elements, u).allFinite()) << f.transpose();
    }
  });
}

TEST(TetrahedraInPieces, InvertedElementReturns) {
  for (const Law law : kLaws) {
    const TetElements<4> elements(linearMesh(law));
    const Eigen::VectorXd u = affine(elements.mesh(), Eigen::Vector3d(-0.5, 1, 1).asDiagonal());
    EXPECT_GT(inSingle(elements, u).gradient.dot(u), 0) << static_cast<int>(law);  // towards rest the energy falls
  }
}

}  // namespace
}  // namespace vibe::benchmarks::tetrahedra_pieces_test
