#include "sparse/panel_kernel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "sparse/aligned_buffer.hpp"
#include "sparse/front_elimination.hpp"
#include "sparse/multifrontal.hpp"

namespace vibe::panel_kernel_test {
namespace {

bool haveAvx2() {
  return widestInstructionSet() != InstructionSet::Sse2;
}

// The nearest number with 11 significant bits, ties to even; zero below `smallest`.
double roundedToHalf(double value, double smallest) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const double rounded = std::ldexp(std::nearbyint(std::ldexp(mantissa, 11)), exponent - 11);
  return std::abs(value) < smallest ? 0.0 : rounded;
}

/// One supernode above the root, with random numbers of very different size, in every storage.
class PanelKernelTest : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  void SetUp() override {
    const auto [nodes, below] = GetParam();
    columns = 3 * nodes;
    rows = columns + 3 * below;
    step = {3, columns, (rows + kTile - 1) / kTile, below, 0, 0};
    stride = step.row_blocks * kTile;
    for (int i = 0; i < below; ++i) index.push_back(3 + columns + 3 * (i + i / 2));  // not consecutive
    vector_size = 3 + columns + 9 * below;
    fill();
  }

  void fill() {
    std::mt19937 generator(static_cast<unsigned>(rows));
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> exponent(-12, 1);
    numbers.assign(static_cast<std::size_t>(stride) * columns, 0.0);
    for (int j = 0; j < columns; ++j)
      for (int i = j; i < rows; ++i)
        numbers[j * stride + i] = normal(generator) * std::pow(10.0, i % 3 == 0 ? exponent(generator) : 0.0);
    half.resize(panelSize(columns, step.row_blocks));
    wide.resize(panelSize(columns, step.row_blocks));
    half_scale.assign(vector_size, 1.0F);
    wide_scale.assign(vector_size, 1.0F);
    ThreadPool single;
    packPanel(FrontPanel<double>{numbers.data(), stride}, step, half.data(), half_scale.data() + 3, single);
    for (int j = 0; j < columns; ++j)  // what the halves ought to be
      for (int i = j; i < rows; ++i) {
        double& number = numbers[j * stride + i];
        number = roundedToHalf(number, std::ldexp(half_scale[3 + j], -14));
      }
    packPanel(FrontPanel<double>{numbers.data(), stride}, step, wide.data(), wide_scale.data() + 3, single);
    for (int i = 0; i < 3 * vector_size; ++i) start.push_back(static_cast<float>(normal(generator)));
  }

  PanelSet set(const void* panel, const float* scale) const { return {&step, 1, index.data(), panel, scale, 8192}; }
  PanelSet halfSet() const { return set(half.data(), half_scale.data()); }
  PanelSet wideSet() const { return set(wide.data(), wide_scale.data()); }

  static void expectNear(const std::vector<float>& a, const std::vector<float>& b) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      error += std::pow(static_cast<double>(a[i]) - b[i], 2);
      size += std::pow(static_cast<double>(b[i]), 2);
    }
    EXPECT_LT(std::sqrt(error), 2e-6 * std::sqrt(size));
  }

  template <class Operation>
  std::vector<float> applied(std::size_t count, const Operation& operation) {
    std::vector<float> vector(start.begin(), start.begin() + count);
    AlignedBuffer<float> work;
    work.resize(3 * stride);
    operation(vector.data(), work.data());
    return vector;
  }

  void expectAsPlain(KernelPath path) {
    const PanelKernels kernels = halfKernels(path), plain = doubleKernels();
    expectNear(applied(vector_size, [&](float* v, float* w) { kernels.forward(halfSet(), v, w); }),
               applied(vector_size, [&](float* v, float* w) { plain.forward(wideSet(), v, w); }));
    expectNear(applied(vector_size, [&](float* v, float* w) { kernels.backward(halfSet(), v, w); }),
               applied(vector_size, [&](float* v, float* w) { plain.backward(wideSet(), v, w); }));
    expectNear(applied(3 * vector_size, [&](float* v, float* w) { kernels.stepOfThree(halfSet(), 0, 0, v, w); }),
               applied(3 * vector_size, [&](float* v, float* w) { plain.stepOfThree(wideSet(), 0, 0, v, w); }));
  }

  /// Of all operations, on halves and floats.
  std::vector<float> allResults(KernelPath path) {
    std::vector<float> all;
    const auto append = [&all](const std::vector<float>& more) { all.insert(all.end(), more.begin(), more.end()); };
    AlignedBuffer<float> single;
    single.resize(wide.size());
    for (std::int64_t i = 0; i < wide.size(); ++i) single.data()[i] = static_cast<float>(wide.data()[i]);
    const auto run = [&](const PanelKernels& kernels, const PanelSet& panel) {
      append(applied(vector_size, [&](float* v, float* w) { kernels.forward(panel, v, w); }));
      append(applied(vector_size, [&](float* v, float* w) { kernels.backward(panel, v, w); }));
      append(applied(3 * vector_size, [&](float* v, float* w) { kernels.stepOfThree(panel, 0, 0, v, w); }));
    };
    run(halfKernels(path), halfSet());
    run(floatKernels(path), set(single.data(), wide_scale.data()));
    return all;
  }

  PanelStep step{};
  int columns = 0, rows = 0, stride = 0, vector_size = 0;
  std::vector<std::int32_t> index;
  std::vector<double> numbers;
  AlignedBuffer<std::uint16_t> half;
  AlignedBuffer<double> wide;
  std::vector<float> half_scale, wide_scale, start;
};

TEST_P(PanelKernelTest, Sse2EqualsPlainLoopsOverRoundedNumbers) {
  expectAsPlain(KernelPath::Plain);
}

TEST_P(PanelKernelTest, Avx2EqualsPlainLoopsOverRoundedNumbers) {
  if (!haveAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  expectAsPlain(KernelPath::Avx2);
}

TEST_P(PanelKernelTest, FusedPathsGiveTheSameBits) {
  if (!haveAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  const std::vector<float> narrow = allResults(KernelPath::FusedSse2);
  EXPECT_EQ(narrow, allResults(KernelPath::Avx2));
  EXPECT_EQ(narrow, allResults(KernelPath::Avx512));
  if (columns > 6) {
    EXPECT_NE(narrow, allResults(KernelPath::Plain));
  }
}

TEST_P(PanelKernelTest, StoresNoSubnormalHalf) {
  int zeros = 0;
  for (std::int64_t i = 0; i < half.size(); ++i) {
    const int exponent = half.data()[i] >> 10 & 31, mantissa = half.data()[i] & 1023;
    EXPECT_TRUE(exponent != 0 || mantissa == 0);
    EXPECT_LT(exponent, 31);
    zeros += exponent == 0 ? 1 : 0;
  }
  EXPECT_LT(zeros, half.size());
}

INSTANTIATE_TEST_SUITE_P(Shapes, PanelKernelTest,
                         ::testing::Values(std::pair(1, 0), std::pair(1, 1), std::pair(2, 3), std::pair(3, 9),
                                           std::pair(4, 2), std::pair(5, 17), std::pair(6, 1), std::pair(7, 0),
                                           std::pair(8, 30), std::pair(21, 11)));

template <class Real>
class DensePrecisionTest : public ::testing::Test {
 protected:
  static constexpr double kTolerance = 500 * std::numeric_limits<Real>::epsilon();
};

using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DensePrecisionTest, Precisions, );

TYPED_TEST(DensePrecisionTest, PathsAgree) {
  if (!haveAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  constexpr int kTileRows = kDenseRows<TypeParam>, kDepth = 13, kPanels = 3, kStride = kTileRows * kPanels + 5;
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  AlignedBuffer<TypeParam> a, b;
  a.resize(kDepth * kPanels * kTileRows);
  b.resize(kDepth * kDenseColumns);
  for (std::int64_t i = 0; i < a.size(); ++i) a.data()[i] = static_cast<TypeParam>(normal(generator));
  for (std::int64_t i = 0; i < b.size(); ++i) b.data()[i] = static_cast<TypeParam>(normal(generator));
  std::map<KernelPath, std::vector<TypeParam>> results;
  for (const KernelPath path : {KernelPath::Plain, KernelPath::FusedSse2, KernelPath::Avx2, KernelPath::Avx512}) {
    std::vector<TypeParam> c(kStride * kDenseColumns, 1);
    denseUpdate<TypeParam>(path)(a.data(), kPanels, b.data(), kDepth, c.data(), kStride);
    for (int j = 0; j < kDenseColumns; ++j)
      for (int i = 0; i < kStride; ++i) {
        double expected = 1;
        for (int k = 0; k < kDepth && i < kTileRows * kPanels; ++k)
          expected -= static_cast<double>(a.data()[(i / kTileRows * kDepth + k) * kTileRows + i % kTileRows]) *
                      static_cast<double>(b.data()[k * kDenseColumns + j]);
        EXPECT_NEAR(static_cast<double>(c[j * kStride + i]), expected, this->kTolerance);
      }
    results[path] = c;
  }
  EXPECT_EQ(results[KernelPath::FusedSse2], results[KernelPath::Avx2]);
  EXPECT_EQ(results[KernelPath::FusedSse2], results[KernelPath::Avx512]);
  EXPECT_NE(results[KernelPath::FusedSse2], results[KernelPath::Plain]);
}

// W and the Schur complement by their definitions, for fronts of one block, of whole blocks and of what lies between
TYPED_TEST(DensePrecisionTest, LeavesTheInverseAndTheSchurComplement) {
  using Elimination = FrontElimination<TypeParam>;
  std::mt19937 generator(6);
  std::normal_distribution<double> normal;
  for (const auto& [rows, columns] : {std::pair(3, 3), std::pair(9, 3), std::pair(48, 48), std::pair(60, 48),
                                      std::pair(51, 51), std::pair(171, 105), std::pair(300, 150)}) {
    SCOPED_TRACE(std::to_string(columns) + " of " + std::to_string(rows));
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(rows, rows, [&] { return normal(generator); });
    const Eigen::MatrixXd a = root * root.transpose() / rows + Eigen::MatrixXd::Identity(rows, rows);
    const std::int64_t stride = Elimination::stride(rows);
    AlignedBuffer<TypeParam> front;
    front.resize(Elimination::size(rows));
    for (int j = 0; j < rows; ++j)
      for (int i = j; i < rows; ++i) front.data()[j * stride + i] = static_cast<TypeParam>(a(i, j));
    Elimination elimination;
    elimination.setLargestFront(rows);
    ThreadPool two(2);
    ASSERT_TRUE(elimination.run(front.data(), rows, columns, two));
    using Dense = Eigen::Matrix<TypeParam, Eigen::Dynamic, Eigen::Dynamic>;
    const Eigen::MatrixXd result =
        Eigen::Map<Dense, 0, Eigen::OuterStride<>>(front.data(), rows, rows, Eigen::OuterStride<>(stride))
            .template cast<double>();
    const int below = rows - columns;
    const Eigen::MatrixXd l = a.llt().matrixL();
    Eigen::MatrixXd w(rows, columns);
    w.topRows(columns) = l.topLeftCorner(columns, columns).inverse();
    w.bottomRows(below) = -l.bottomLeftCorner(below, columns) * w.topRows(columns);
    EXPECT_LT((result.leftCols(columns) - w).norm(), this->kTolerance * w.norm());
    const Eigen::MatrixXd rest = l.bottomRightCorner(below, below) * l.bottomRightCorner(below, below).transpose();
    const Eigen::MatrixXd difference = result.bottomRightCorner(below, below) - rest;
    EXPECT_LE(difference.triangularView<Eigen::Lower>().toDenseMatrix().norm(), this->kTolerance * a.norm());
  }
}

}  // namespace
}  // namespace vibe::panel_kernel_test
