#include <gtest/gtest.h>

#include "tissue/shell_worlds.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::shell_fibres_test {
namespace {

using namespace test;
using V = Eigen::Vector3d;

constexpr double kModulus = 2e4, kStiffening = 1.5;

ShellMesh fibred(ShellMesh mesh, const V& one, const V& other = V::Zero(), double modulus = kModulus) {
  mesh.fibres.stiffening = kStiffening;
  mesh.fibres.modulus.assign(mesh.triangles.size(), modulus);
  mesh.fibres.direction.assign(mesh.triangles.size(), {one, other});
  return mesh;
}

/// Of one family, per volume.
double fibreEnergy(double squared_stretch) {
  const double strain = std::max(squared_stretch - 1, 0.0);
  return kModulus / (2 * kStiffening) * std::expm1(kStiffening * strain * strain);
}

/// What fibres add to the energy of a sheet under a deformation, per volume.
double added(const V& one, const V& other, const Eigen::Matrix3d& deformation) {
  const ShellMesh plain = shaken(sheet(6, 5), 0.1 * kSide, true);
  const Eigen::VectorXd u = affine(plain, deformation);
  double volume = 0;
  const ShellElements with(fibred(plain, one, other)), without(plain);
  for (const double mass : without.lumpedMass(1)) volume += mass;
  return (inDouble(with, u).energy - inDouble(without, u).energy) / volume;
}

V inPlane(double angle) {
  return {std::cos(angle), std::sin(angle), 0};
}

TEST(ShellFibres, ResistAlongAndNotAcross) {
  const Eigen::Matrix3d longer = V(1.3, 1 / std::sqrt(1.3), 1).asDiagonal();
  EXPECT_NEAR(added(V::UnitX(), V::Zero(), longer), fibreEnergy(1.69), 1e-9 * kModulus);
  EXPECT_GT(fibreEnergy(1.69), 0.2 * kModulus);
  EXPECT_NEAR(added(V::UnitY(), V::Zero(), longer), 0, 1e-9 * kModulus) << "fibres do not bear compression";
}

TEST(ShellFibres, TwoFamiliesAddUpInBiaxialStretchAndShear) {
  Eigen::Matrix3d f = V(1.2, 1.1, 1).asDiagonal();
  f(0, 1) = 0.15;
  for (const double angle : {0.0, 0.4, 0.8, 1.5}) {
    const V a = inPlane(angle), b = inPlane(-angle);
    const double expected = fibreEnergy((f * a).squaredNorm()) + fibreEnergy((f * b).squaredNorm());
    EXPECT_NEAR(added(a, b, f), expected, 1e-9 * kModulus) << angle;
  }
  // the control: the angle matters
  EXPECT_GT(std::abs(added(inPlane(0.4), V::Zero(), f) - added(inPlane(-0.4), V::Zero(), f)), 0.05 * kModulus);
}

TEST(ShellFibres, OnlyTheirDirectionWithinTheWallCounts) {
  const Eigen::Matrix3d f = V(1.3, 1, 1).asDiagonal();
  EXPECT_NEAR(added(V(3, 0, 2), V::Zero(), f), fibreEnergy(1.69), 1e-9 * kModulus);
  EXPECT_NEAR(added(V::UnitZ(), V::Zero(), f), 0, 1e-9 * kModulus);
}

TEST(ShellFibres, DoNotFeelRotations) {
  const ShellElements elements(fibred(patchwork(Law::Yeoh), V(1, 1, 0), V(1, -2, 0)));
  const Eigen::VectorXd u = affine(elements.mesh(), V(1.2, 1.1, 1).asDiagonal());
  const Eigen::Matrix3d turn = someRotation();
  Eigen::VectorXd turned(u.size());
  for (Eigen::Index i = 0; i < u.size(); i += 3) {
    const V& x = elements.mesh().nodes[static_cast<std::size_t>(i / 3)];
    turned.segment<3>(i) = turn * (x + u.segment<3>(i)) - x;
  }
  ShellMesh free = elements.mesh();
  free.fixed.clear();  // a clamp would hold the tangent plane
  const ShellElements loose(free);
  EXPECT_NEAR(inDouble(loose, turned).energy, inDouble(loose, u).energy, 1e-9 * inDouble(loose, u).energy);
}

/// Everything that holds for a shell holds with fibres, on sheets with all kinds of side and on closed ones.
void forFibredShells(const std::function<void(const ShellElements&)>& check, ShellKernel kernel = shellKernel()) {
  check(ShellElements(fibred(patchwork(Law::Yeoh), V(1, 1, 0), V(1, -2, 0)), {0.02, 0.01, 0}, kernel));
  check(ShellElements(fibred(shaken(sphere(1, 2 * kSide), 0.1 * kSide), V::UnitZ(), V(1, 1, 1)), {0, 0, 0}, kernel));
}

TEST(ShellFibres, GradientIsTheDerivativeOfTheEnergy) {
  forFibredShells([](const ShellElements& elements) {
    Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), 0.3 * kSide);
    const Eigen::VectorXd gradient = inDouble(elements, u).gradient;
    const double h = 1e-6 * kSide;
    for (Eigen::Index i = 0; i < u.size(); i += 5) {
      const double at = u[i];
      u[i] = at + h;
      const double more = inDouble(elements, u).energy;
      u[i] = at - h;
      const double less = inDouble(elements, u).energy;
      u[i] = at;
      EXPECT_NEAR((more - less) / (2 * h), gradient[i], 1e-6 * gradient.norm());
    }
  });
}

TEST(ShellFibres, SingleIsDoubleOnBothPaths) {
  for (const ShellKernel& kernel : {shellKernelSse2(), shellKernel()})
    forFibredShells(
        [](const ShellElements& elements) {
          for (const double amount : {1e-3, 0.1, 3.0}) {
            const Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), amount * kSide);
            const Evaluation d = inDouble(elements, u), f = inSingle(elements, u);
            // at absurd strains the thickness of the wall is less exact: a lane stops after a step below 5 %
            EXPECT_LT((d.gradient - f.gradient).norm(), (amount < 1 ? 2e-5 : 4e-5) * d.gradient.norm()) << amount;
            EXPECT_NEAR(f.energy, d.energy, 2e-5 * d.energy) << amount;
          }
        },
        kernel);
}

TEST(ShellFibres, FusedPathsGiveTheSameBits) {
  if (widestInstructionSet() == InstructionSet::Sse2) GTEST_SKIP() << "this machine has no AVX2";
  std::vector<Evaluation> all;
  for (const ShellKernel& kernel : {shellKernelFusedSse2(), shellKernelAvx2(), shellKernelSse2()})
    forFibredShells(
        [&all](const ShellElements& elements) {
          all.push_back(inSingle(elements, randomDisplacement(elements.nodeCount(), 0.3 * kSide)));
        },
        kernel);
  const std::size_t count = all.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_EQ(all[k].energy, all[count + k].energy);
    EXPECT_EQ(all[k].gradient, all[count + k].gradient);
    EXPECT_NE(all[k].gradient, all[2 * count + k].gradient) << "plain arithmetic";
  }
}

TEST(ShellFibres, StiffnessIsTheSecondDerivativeWhereTheWallIsFlatAndInTension) {
  ShellMesh mesh = fibred(shaken(sheet(4, 3), 0.12 * kSide, true), V(1, 0.5, 0), V(1, -0.5, 0));
  const ShellElements elements(mesh);
  Eigen::VectorXd u = affine(mesh, V(1.25, 1.15, 1).asDiagonal());
  const Eigen::MatrixXd ours = denseStiffness(elements, u);
  const double h = 1e-6 * kSide;
  for (Eigen::Index i = 0; i < u.size(); i += 4) {
    const double at = u[i];
    u[i] = at + h;
    Eigen::VectorXd column = inDouble(elements, u).gradient;
    u[i] = at - h;
    column = (column - inDouble(elements, u).gradient) / (2 * h);
    u[i] = at;
    EXPECT_LT((column - ours.col(i)).norm(), 1e-6 * column.norm());
  }
}

TEST(ShellFibres, StiffnessIsPositiveSemidefiniteInAnyState) {
  forFibredShells([](const ShellElements& elements) {
    for (const double amount : {0.2, 1.0, 10.0}) {
      const Eigen::MatrixXd k = denseStiffness(elements, randomDisplacement(elements.nodeCount(), amount * kSide));
      ASSERT_TRUE(k.allFinite());
      const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
      EXPECT_GT(values.minCoeff(), -1e-12 * values.maxCoeff()) << amount;
    }
  });
}

TEST(ShellFibres, AreFiniteAtAnyStretch) {
  const ShellElements elements(fibred(sphere(1, kSide), V::UnitZ()));
  const Evaluation far = inSingle(elements, affine(elements.mesh(), V(1, 1, 1000).asDiagonal()));
  EXPECT_TRUE(std::isfinite(far.energy));
  EXPECT_TRUE(far.gradient.allFinite());
}

// Without fibres every bit is that of a wall that knows of none; fibres of no modulus change no more than rounding.
TEST(ShellFibres, WithoutModulusAreNotThere) {
  const ShellMesh plain = patchwork(Law::Fung);
  const ShellElements none(plain), idle(fibred(plain, V::UnitX(), V::UnitY(), 0));
  const Eigen::VectorXd u = randomDisplacement(none.nodeCount(), 0.2 * kSide);
  EXPECT_LT((inSingle(none, u).gradient - inSingle(idle, u).gradient).norm(), 1e-6 * inSingle(none, u).gradient.norm());
}

TEST(ShellFibres, AreRefusedOutOfRange) {
  EXPECT_THROW(ShellElements(fibred(sheet(2, 2), V::UnitX(), V::Zero(), -1)), Error);
  ShellMesh mesh = fibred(sheet(2, 2), V::UnitX());
  mesh.fibres.stiffening = 0;
  EXPECT_THROW(ShellElements{mesh}, Error);
  mesh = fibred(sheet(2, 2), V::UnitX());
  mesh.fibres.direction.pop_back();
  EXPECT_THROW(ShellElements{mesh}, Error);
}

}  // namespace
}  // namespace vibe::shell_fibres_test
