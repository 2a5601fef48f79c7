// The stress that a wall remembers: its forces and its work are those of the membrane, in every kernel; and what it
// has relaxed.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "tissue/relaxation_kernel.hpp"
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

// Beside the law of a wall: its gradient and its work are those that it has alone, in parts of the wall as well.
TEST(ShellStress, AConstantStressActsBesideTheLaw) {
  forAllShells([](const ShellElements& shell) {
    const std::vector<float> here = fourFloats(randomDisplacement(shell.nodeCount(), 0.1 * kSide));
    const Stressed there(shell, fourFloats(randomDisplacement(shell.nodeCount(), 0.05 * kSide)));
    std::vector<float> law(here.size(), 0.0F), both = law, alone = law;
    const double energy = shell.evaluate(0, here.data(), law.data());
    const double work = shell.stressWork(there.stress.data(), here.data(), alone.data());
    ConstantStress beside{there.stress.data()};
    double no_volume = 0;
    EXPECT_EQ(shell.evaluate(0, here.data(), both.data(), nullptr, no_volume, &beside), energy);
    EXPECT_NEAR(beside.work, work, 1e-6 * std::abs(work));
    const Eigen::VectorXd added = threeDoubles(both) - threeDoubles(law), expected = threeDoubles(alone);
    EXPECT_LT((added - expected).norm(), 1e-5 * (expected.norm() + threeDoubles(law).norm()));
    EXPECT_GT(expected.norm(), 0.01 * threeDoubles(law).norm());  // control: it would be seen
  });
}

TEST(ShellStress, KernelsHaveTheSameBitsBesideAConstantStress) {
  if (widestInstructionSet() == InstructionSet::Sse2) GTEST_SKIP() << "this machine has no AVX2";
  const bool wide = widestInstructionSet() == InstructionSet::Avx512;
  const ShellMesh mesh = patchwork(Law::Yeoh);
  const std::vector<float> here = fourFloats(randomDisplacement(static_cast<int>(mesh.nodes.size()), 0.1 * kSide));
  const auto run = [&](const ShellKernel& kernel) {
    const ShellElements shell(mesh, {0, 0, 0}, kernel);
    const Stressed found(shell, here);
    std::vector<float> gradient(here.size(), 0.0F);
    ConstantStress beside{found.stress.data()};
    double no_volume = 0;
    const double energy = shell.evaluate(0, here.data(), gradient.data(), nullptr, no_volume, &beside);
    return std::make_tuple(energy, beside.work, gradient);
  };
  for (const ShellKernel& kernel : {shellKernelFusedSse2(), wide ? shellKernelAvx512() : shellKernelAvx2()})
    EXPECT_EQ(run(shellKernelAvx2()), run(kernel));
}

TEST(ShellStress, StressTimesStrainIsItsWork) {
  forAllShells([](const ShellElements& shell) {
    const std::vector<float> here = fourFloats(randomDisplacement(shell.nodeCount(), 0.1 * kSide));
    const Stressed found(shell, here);
    std::vector<float> stress(found.stress.size()), strain(stress);
    EXPECT_EQ(shell.stress(here.data(), stress.data(), strain.data()), found.energy);
    EXPECT_EQ(stress, found.stress);
    double sum = 0;
    for (std::size_t i = 0; i < stress.size(); ++i) sum += static_cast<double>(stress[i]) * strain[i];
    EXPECT_NEAR(sum, found.work, 1e-5 * std::abs(found.work));
  });
}

TEST(ShellStress, KernelsOfRelaxationHaveTheSameBits) {
  if (widestInstructionSet() == InstructionSet::Sse2) GTEST_SKIP() << "this machine has no AVX2";
  const std::size_t size = 3 * kStressRows * kBatchLanes;
  const PronyTerm terms[] = {{0.3F, 0.99F, 0.98F, 0.297F, 0.97, 0.98}, {0.2F, 0.9F, 0.8F, 0.18F, 0.6, 0.8}};
  const auto numbers = [](std::size_t count, double phase) {
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i)
      out.push_back(static_cast<float>(std::sin(phase + 0.37 * static_cast<double>(i) * (1 + phase))));
    return out;
  };
  const std::vector<float> law = numbers(size, 0.1), strain = numbers(size, 0.2), law_end = numbers(size, 0.3),
                           strain_end = numbers(size, 0.4);
  const RelaxationSweep sweep{size, law.data(), strain.data(), law_end.data(), strain_end.data()};
  const auto run = [&](const RelaxationKernel& kernel) {
    std::vector<float> over = numbers(2 * size, 0.5), relaxed(size);
    const double stored = kernel.relaxed(sweep, terms, 2, over.data(), relaxed.data());
    const double first = kernel.advance(sweep, terms[0], over.data());
    const double second = kernel.advance(sweep, terms[1], over.data() + size);
    double work = 0;  // of both is that of what had relaxed
    for (std::size_t i = 0; i < size; ++i) work -= static_cast<double>(relaxed[i]) * (strain_end[i] - strain[i]);
    EXPECT_NEAR(first + second, work, 1e-5 * std::abs(work));
    return std::make_tuple(stored, first, second, over, relaxed);
  };
  EXPECT_EQ(run(relaxationKernelSse2()), run(relaxationKernelAvx2()));
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
