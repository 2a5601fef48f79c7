// Columns of nodes and attachment points: their products are compliances, whatever was known before.
#include "solver/column_cache.hpp"
#include "solver/half_rows.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>

#include "sparse/closed_mesh.hpp"

namespace vibe::column_cache_test {
namespace {

struct System {
  System() : matrix(test::shellMatrix(test::closedMesh(3), 1.0, 0.3)) {
    const int rows = 3 * matrix.pattern().size;
    Eigen::MatrixXd dense(rows, rows);
    for (int i = 0; i < rows; ++i) matrix.multiply(Eigen::VectorXd::Unit(rows, i).eval().data(), dense.col(i).data());
    inverse = dense.inverse();
    factor = std::make_unique<Factor>(makeFactorPlan(matrix.pattern()), FactorStorage::Double);
    EXPECT_TRUE(factor->compute(matrix));
  }
  Eigen::Matrix3f compliance(const AttachmentPoint& a, const AttachmentPoint& b) const {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < a.node.size(); ++i)
      for (std::size_t j = 0; j < b.node.size(); ++j)
        sum += a.weight[i] * b.weight[j] * inverse.block<3, 3>(3 * a.node[i], 3 * b.node[j]);
    return sum.cast<float>();
  }
  Eigen::Matrix3f gram(int a, int b) {
    cache.makeGrams(a, {b}, 1);
    return a >= b ? cache.gram(a, b) : Eigen::Matrix3f(cache.gram(b, a).transpose());
  }
  BlockMatrix matrix;
  Eigen::MatrixXd inverse;
  std::unique_ptr<Factor> factor;
  ColumnCache cache;
};

const RowList<AttachmentPoint> kPoints{{{2, 3}, {0.5, 0.5}}, {{30}, {1}}, {{60, 61, 5}, {0.3, 0.6, 0.1}}};
constexpr float kTolerance = 2e-5F;  // relative: columns are single precision

TEST(ColumnCache, ProductsAreCompliances) {
  System system;
  system.cache.setAttachments(*system.factor, kPoints);
  const AttachmentPoint node{{17}, {1}};
  const int slot = system.cache.nodeSlot(*system.factor, 17);
  for (int a = 0; a < 3; ++a) {
    const int at = system.cache.attachmentSlot(a);
    const Eigen::Matrix3f expected = system.compliance(kPoints[static_cast<std::size_t>(a)], node);
    EXPECT_LT((system.gram(at, slot) - expected).norm(), kTolerance * expected.norm());
    for (int b = 0; b < 3; ++b) {
      const Eigen::Matrix3f both =
          system.compliance(kPoints[static_cast<std::size_t>(a)], kPoints[static_cast<std::size_t>(b)]);
      EXPECT_LT((system.gram(at, system.cache.attachmentSlot(b)) - both).norm(), kTolerance * both.norm());
    }
  }
}

TEST(ColumnCache, TheOrderDoesNotChangeTheBits) {
  System one, other;
  for (const int node : {4, 40, 7}) one.cache.nodeSlot(*one.factor, node);
  one.cache.setAttachments(*one.factor, kPoints);
  other.cache.prepare(*other.factor, {7, 40, 4, 12}, kPoints);
  for (const int a : {4, 7, 40})
    for (const int b : {4, 7, 40})
      EXPECT_EQ(one.gram(one.cache.nodeSlot(*one.factor, a), one.cache.nodeSlot(*one.factor, b)),
                other.gram(other.cache.nodeSlot(*other.factor, a), other.cache.nodeSlot(*other.factor, b)));
  EXPECT_EQ(one.gram(one.cache.attachmentSlot(2), one.cache.nodeSlot(*one.factor, 7)),
            other.gram(other.cache.attachmentSlot(2), other.cache.nodeSlot(*other.factor, 7)));
}

TEST(ColumnCache, ProductsOfSeveralColumnsHaveTheBitsOfEach) {
  System system;
  const Eigen::VectorXf y = Eigen::VectorXf::LinSpaced(system.factor->rows(), -1, 2);
  for (const std::array<int, kProducts>& nodes :
       {std::array<int, kProducts>{4, 40, 7, 12}, {9, 9, 9, 9}, {0, 1, 2, 60}}) {
    std::array<HalfColumns, kProducts> columns;
    std::array<const HalfColumns*, kProducts> asked;
    for (std::size_t c = 0; c < kProducts; ++c) {
      system.factor->halfColumns(nodes[c], columns[c]);
      asked[c] = &columns[c];
    }
    std::array<Eigen::Vector3f, kProducts> found;
    productsOf(asked, y.data(), found.data());
    for (std::size_t c = 0; c < kProducts; ++c) {
      EXPECT_EQ(found[c], product(columns[c], y.data()));
      const float* value = columns[c].value.data();
      Eigen::Vector3f expected = Eigen::Vector3f::Zero();
      for (std::size_t i = 0; i < columns[c].begin.size(); ++i)
        for (int r = 0; r < columns[c].count[i]; ++r, value += 3)
          for (int k = 0; k < 3; ++k) expected[k] += value[k] * y[columns[c].begin[i] + r];
      EXPECT_EQ(found[c], expected) << nodes[c];
    }
    for (const int node : {0, 7, 33}) {
      HalfColumns other;
      system.factor->halfColumns(node, other);
      std::array<Eigen::Matrix3f, kProducts> grams;
      productsOf(asked, other, grams.data());
      for (std::size_t c = 0; c < kProducts; ++c) EXPECT_EQ(grams[c], product(columns[c], other)) << nodes[c];
      EXPECT_EQ(grams[0], product(other, columns[0]).transpose());
    }
  }
}

TEST(ColumnCache, ForgetsWhatHasChangedAndKeepsTheRest) {
  System system;
  system.cache.prepare(*system.factor, {5, 9}, kPoints);
  const int kept = system.cache.attachmentSlot(0);
  RowList<AttachmentPoint> changed = kPoints;
  changed[1] = {{31}, {1}};
  system.cache.setAttachments(*system.factor, changed);
  EXPECT_EQ(system.cache.attachmentSlot(0), kept);
  const Eigen::Matrix3f expected = system.compliance(changed[1], {{9}, {1}});
  const int slot = system.cache.nodeSlot(*system.factor, 9);
  EXPECT_LT((system.gram(system.cache.attachmentSlot(1), slot) - expected).norm(), kTolerance * expected.norm());
  std::vector<int> many(1000);
  std::iota(many.begin(), many.end(), 9);
  const int unneeded = system.cache.nodeSlot(*system.factor, 5);
  system.cache.makeRoom(many);
  EXPECT_EQ(system.cache.nodeSlot(*system.factor, 9), slot) << "what is needed next stays";
  const int again = system.cache.nodeSlot(*system.factor, 50);
  EXPECT_EQ(again, unneeded) << "its slot is free";
  const Eigen::Matrix3f fresh = system.compliance(changed[1], {{50}, {1}});
  EXPECT_LT((system.gram(system.cache.attachmentSlot(1), again) - fresh).norm(), kTolerance * fresh.norm());
  EXPECT_LT(system.cache.key(again), system.cache.key(kept)) << "nodes come before attachment points";
}

}  // namespace
}  // namespace vibe::column_cache_test
