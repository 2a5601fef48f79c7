#include "tissue/shell_kernel.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tissue/shell_worlds.hpp"

namespace vibe::shell_kernel_test {
namespace {

using namespace test;

void expectSingleIsDouble(ShellKernel kernel) {
  forAllShells(
      [](const ShellElements& elements) {
        for (const double amount : {1e-6, 1e-3, 0.1}) {
          const Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), amount * kSide);
          const Evaluation d = inDouble(elements, u), f = inSingle(elements, u);
          EXPECT_LT((d.gradient - f.gradient).norm(), 2e-5 * d.gradient.norm()) << amount;
          EXPECT_NEAR(f.energy, d.energy, 2e-5 * d.energy) << amount;
        }
      },
      kernel);
}

bool haveAvx2() {
  return widestInstructionSet() != InstructionSet::Sse2;
}

TEST(ShellKernel, SingleIsDoubleOnTheSse2Path) {
  expectSingleIsDouble(shellKernelSse2());
}

TEST(ShellKernel, SingleIsDoubleOnTheAvx2Path) {
  if (!haveAvx2()) GTEST_SKIP() << "this machine has no AVX2";
  expectSingleIsDouble(shellKernelAvx2());
}

TEST(ShellKernel, PathsAgree) {
  if (!haveAvx2()) GTEST_SKIP() << "this machine has no AVX2";
  for (const Law law : kLaws) {
    const ShellElements narrow(patchwork(law), Eigen::Vector3d::Zero(), shellKernelSse2());
    const ShellElements wide(patchwork(law), Eigen::Vector3d::Zero(), shellKernelAvx2());
    const Eigen::VectorXd u = randomDisplacement(narrow.nodeCount(), 0.1 * kSide);
    const Evaluation a = inSingle(narrow, u), b = inSingle(wide, u);
    EXPECT_LT((a.gradient - b.gradient).norm(), 1e-5 * a.gradient.norm());
    EXPECT_LT((a.volume_gradient - b.volume_gradient).norm(), 1e-6 * a.volume_gradient.norm());
    EXPECT_NEAR(a.volume, b.volume, 1e-6 * std::abs(a.volume) + 1e-12);
  }
}

// Small, usual and absurd strains: lanes that need one, several and the rare steps of Newton's method side by side.
void forTwoKernels(const ShellKernel& one, const ShellKernel& other,
                   const std::function<void(const Evaluation&, const Evaluation&)>& compare) {
  for (const Law law : kLaws)
    for (const double amount : {1e-3, 0.1, 0.5, 3.0}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(law)) + " " + std::to_string(amount));
      const ShellMesh mesh = patchwork(law);
      const ShellElements narrow(mesh, Eigen::Vector3d(0.01, 0, 0), one),
          wide(mesh, Eigen::Vector3d(0.01, 0, 0), other);
      Eigen::VectorXd u = randomDisplacement(narrow.nodeCount(), 1e-3 * kSide);
      u.tail(u.size() / 2) = randomDisplacement(narrow.nodeCount(), amount * kSide).tail(u.size() / 2);
      compare(inSingle(narrow, u), inSingle(wide, u));
    }
}

void expectSameBits(const Evaluation& a, const Evaluation& b) {
  EXPECT_EQ(a.energy, b.energy);
  EXPECT_EQ(a.gradient, b.gradient);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.volume_gradient, b.volume_gradient);
}

TEST(ShellKernel, FusedSse2PathHasTheBitsOfAvx2) {
  if (!haveAvx2()) GTEST_SKIP() << "this machine has no AVX2";
  forTwoKernels(shellKernelFusedSse2(), shellKernelAvx2(), expectSameBits);
}

TEST(ShellKernel, Avx512PathHasTheBitsOfAvx2) {
  if (widestInstructionSet() != InstructionSet::Avx512) GTEST_SKIP() << "this machine has no AVX-512";
  forTwoKernels(shellKernelAvx512(), shellKernelAvx2(), expectSameBits);
}

TEST(ShellKernel, PlainArithmeticHasOtherBits) {
  forTwoKernels(shellKernelSse2(), shellKernelFusedSse2(),
                [](const Evaluation& a, const Evaluation& b) { EXPECT_NE(a.gradient, b.gradient); });
}

TEST(ShellKernel, PiecesAddUpAndAreTheSameEveryTime) {
  const ShellElements elements(shaken(sheet(40, 30), 0.1 * kSide));
  ASSERT_GT(elements.pieceCount(), 1);
  const Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), 0.1 * kSide);
  const Evaluation d = inDouble(elements, u), f = inSingle(elements, u);
  EXPECT_NEAR(f.energy, d.energy, 1e-5 * d.energy);
  EXPECT_NEAR(f.volume, d.volume, 1e-6 * std::abs(d.volume) + 1e-12);
  const std::vector<float> in = fourFloats(u);
  double energy = 0, volume = 0;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(u.size());
  for (int piece = elements.pieceCount() - 1; piece >= 0; --piece) {
    std::vector<float> own(in.size(), 0.0f), again(in.size(), 0.0f), area(in.size(), 0.0f);
    const double part = elements.evaluate(piece, in.data(), own.data(), area.data(), volume);
    EXPECT_EQ(elements.evaluate(piece, in.data(), again.data()), part);
    EXPECT_EQ(own, again);
    EXPECT_LT(part, 0.5 * d.energy);  // no piece does it all
    energy += part;
    sum += threeDoubles(own);
  }
  EXPECT_NEAR(energy, f.energy, 1e-12 * energy);
  EXPECT_LT((sum - d.gradient).norm(), 2e-5 * d.gradient.norm());
}

TEST(ShellKernel, GarbageGivesFiniteForces) {
  for (const ShellKernel kernel : {shellKernelSse2(), shellKernel()})
    forAllShells(
        [](const ShellElements& elements) {
          const auto check = [&](const Eigen::VectorXd& u, const char* what) {
            const Evaluation f = inSingle(elements, u), d = inDouble(elements, u);
            EXPECT_TRUE(std::isfinite(f.energy) && f.gradient.allFinite()) << what;
            EXPECT_TRUE(std::isfinite(d.energy) && d.gradient.allFinite()) << what;
          };
          const ShellMesh& mesh = elements.mesh();
          check(affine(mesh, Eigen::Matrix3d::Zero()), "point");
          check(affine(mesh, Eigen::Vector3d(1, 0, 0).asDiagonal()), "line");
          check(affine(mesh, Eigen::Vector3d(1, 1, 0).asDiagonal()), "plane");
          check(affine(mesh, Eigen::Vector3d(-1, 1, 1).asDiagonal()), "mirrored");
          check(affine(mesh, Eigen::Vector3d(1e-3, 1, 1).asDiagonal()), "squeezed");
          for (const double amount : {1.0, 10.0, 1000.0})
            check(randomDisplacement(elements.nodeCount(), amount * kSide), "random");
        },
        kernel);
}

TEST(ShellKernel, SqueezedSheetIsPushedBack) {
  for (const Law law : kLaws) {
    const ShellElements elements(sheet(4, 3, law));
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(3 * elements.nodeCount());
    for (const double squeeze : {0.5, 0.1, 1e-3}) {
      const Eigen::VectorXd u = affine(elements.mesh(), Eigen::Vector3d(squeeze, 1, 1).asDiagonal());
      EXPECT_LT(inSingle(elements, u).gradient.dot(rest - u), 0) << static_cast<int>(law) << ' ' << squeeze;
    }
    const Eigen::VectorXd both = affine(elements.mesh(), Eigen::Vector3d(0.5, 0.5, 1).asDiagonal());
    EXPECT_LT(inSingle(elements, both).gradient.dot(rest - both), 0) << static_cast<int>(law);
  }
}

}  // namespace
}  // namespace vibe::shell_kernel_test
