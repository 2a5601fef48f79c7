// The stress that a wall remembers: its forces and its work are those of the membrane, in every kernel.
#include <gtest/gtest.h>

#include "tissue/shell_worlds.hpp"

namespace vibe::shell_stress_test {
namespace {

using namespace test;

// In its plane a sheet does not bend, so that all of its energy is that of the membrane.
ShellMesh flatSheet(Law law) {
  ShellMesh mesh = shaken(sheet(4, 3, law), 0.12 * kSide, true);
  mesh.materials.push_back({law, 2 * kE, 0.3, 0.5});
  mesh.material.assign(mesh.triangles.size(), 0);
  for (std::size_t e = 0; e < mesh.triangles.size(); e += 3) mesh.material[e] = 1, mesh.thickness[e] = 0.002;
  mesh.hinged = {{8, 9}};
  return mesh;
}

Eigen::VectorXd inPlane(int nodes, double amount) {
  Eigen::VectorXd u = randomDisplacement(nodes, amount);
  for (Eigen::Index i = 2; i < u.size(); i += 3) u[i] = 0;
  return u;
}

struct Stressed {
  std::vector<float> stress, gradient;
  double energy, work;  // work: of the stress from rest to here

  Stressed(const ShellElements& shell, const std::vector<float>& u4)
      : stress(shell.stressCount()), gradient(u4.size(), 0.0F) {
    energy = shell.stress(u4.data(), stress.data());
    work = shell.stressWork(stress.data(), u4.data(), gradient.data());
  }
};

void expectMembrane(const ShellElements& shell, const std::vector<float>& u4) {
  std::vector<float> gradient(u4.size(), 0.0F);
  const double energy = shell.evaluate(0, u4.data(), gradient.data());
  const Stressed found(shell, u4);
  EXPECT_NEAR(found.energy, energy, 1e-6 * energy);
  EXPECT_LT((threeDoubles(found.gradient) - threeDoubles(gradient)).norm(), 1e-5 * threeDoubles(gradient).norm());
}

TEST(ShellStress, ForcesAndEnergyAreThoseOfTheMembrane) {
  for (const Law law : kLaws) {
    SCOPED_TRACE(static_cast<int>(law));
    const ShellElements shell(flatSheet(law));
    expectMembrane(shell, fourFloats(inPlane(shell.nodeCount(), 0.1 * kSide)));
  }
}

TEST(ShellStress, FibresAndMuscleAreInIt) {
  ShellMesh mesh = flatSheet(Law::Yeoh);
  mesh.fibres.modulus.assign(mesh.triangles.size(), 2e4);
  mesh.fibres.direction.assign(mesh.triangles.size(), {Eigen::Vector3d(1, 0.3, 0), Eigen::Vector3d(0.2, 1, 0)});
  const std::vector<float> plain = fourFloats(inPlane(static_cast<int>(mesh.nodes.size()), 0.1 * kSide));
  expectMembrane(ShellElements(mesh), plain);
  mesh.muscle.assign(mesh.triangles.size(), Eigen::Vector3d(1, 1, 0));
  std::vector<float> contracted = plain;
  for (std::size_t i = 3; i < contracted.size(); i += 4) contracted[i] = 0.2F;
  const ShellElements shell(mesh);
  expectMembrane(shell, contracted);
  EXPECT_NE(Stressed(shell, contracted).energy, Stressed(shell, plain).energy);  // control: the muscle counts
}

// In small displacements the bending stiffness does not see the stretch, so that stress and moments make all forces.
TEST(ShellStress, MomentsBendAsTheWallDoes) {
  forAllShells([](const ShellElements& shell) {
    const Eigen::VectorXd u = randomDisplacement(shell.nodeCount(), 1e-4 * kSide);
    const Evaluation whole = inSingle(shell, u);
    const Stressed found(shell, fourFloats(u));
    EXPECT_NEAR(found.energy, whole.energy, 1e-6 * whole.energy);
    EXPECT_LT((threeDoubles(found.gradient) - whole.gradient).norm(), 2e-3 * whole.gradient.norm());
  });
}

// Half the stress at rest times the strain is the energy, to first order in the strain.
TEST(ShellStress, WorkOfALinearStressIsTwiceTheEnergy) {
  const ShellElements shell(sphere(1, 2 * kSide));
  const Eigen::VectorXd u = affine(shell.mesh(), 1.001 * Eigen::Matrix3d::Identity());
  const Stressed found(shell, fourFloats(u));
  EXPECT_NEAR(found.work, 2 * found.energy, 0.01 * found.energy);
}

TEST(ShellStress, KernelsHaveTheSameBits) {
  if (widestInstructionSet() == InstructionSet::Sse2) GTEST_SKIP() << "this machine has no AVX2";
  const bool wide = widestInstructionSet() == InstructionSet::Avx512;
  for (const Law law : kLaws) {
    const ShellMesh mesh = patchwork(law);
    const std::vector<float> u4 = fourFloats(randomDisplacement(static_cast<int>(mesh.nodes.size()), 0.1 * kSide));
    const Stressed first(ShellElements(mesh, {0, 0, 0}, shellKernelAvx2()), u4);
    for (const ShellKernel& kernel : {shellKernelFusedSse2(), wide ? shellKernelAvx512() : shellKernelAvx2()}) {
      const Stressed other(ShellElements(mesh, {0, 0, 0}, kernel), u4);
      EXPECT_EQ(first.stress, other.stress);
      EXPECT_EQ(first.gradient, other.gradient);
      EXPECT_EQ(first.energy, other.energy);
      EXPECT_EQ(first.work, other.work);
    }
  }
}

}  // namespace
}  // namespace vibe::shell_stress_test
