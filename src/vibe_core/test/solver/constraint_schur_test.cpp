// The block elimination against a dense solve of the whole system: A x = b + Jt f, J x = rhs - C f.
#include "solver/constraint_schur.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "sparse/closed_mesh.hpp"

namespace vibe::constraint_schur_test {
namespace {

using test::closedMesh;
using test::shellMatrix;

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const int rows = 3 * matrix.pattern().size;
  Eigen::MatrixXd result(rows, rows);
  for (int i = 0; i < rows; ++i) matrix.multiply(Eigen::VectorXd::Unit(rows, i).eval().data(), result.col(i).data());
  return result;
}

struct System {
  explicit System(int thread_guesses = ThreadSlides::kGuesses)
      : matrix(shellMatrix(closedMesh(3), 1.0, 0.3)), a(dense(matrix)), inverse(a.inverse()), schur(thread_guesses) {
    factor = std::make_unique<Factor>(makeFactorPlan(matrix.pattern()), FactorStorage::Double);
    EXPECT_TRUE(factor->compute(matrix));
    schur.reset(*factor);
    std::mt19937 generator(5);
    std::normal_distribution<double> normal;
    b = Eigen::VectorXd::NullaryExpr(3 * nodes(),
                                     [&] { return static_cast<double>(static_cast<float>(normal(generator))); });
    gas = Eigen::VectorXd::NullaryExpr(3 * nodes(),
                                       [&] { return static_cast<double>(static_cast<float>(normal(generator))); });
  }

  int nodes() const { return matrix.pattern().size; }

  std::vector<float> four(const Eigen::VectorXd& v) const {
    std::vector<float> result(4 * static_cast<std::size_t>(nodes()), 0.0F);
    for (int i = 0; i < v.size(); ++i) result[4 * (i / 3) + i % 3] = static_cast<float>(v[i]);
    return result;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& rhs, double swelling = 0) {
    std::vector<float> half(static_cast<std::size_t>(factor->rows()) + 16, 0.0F), out = four(b);
    factor->load(out.data(), half.data());
    factor->forward(half.data());
    schur.eliminate(rhs, swelling, half.data());
    factor->backward(half.data());
    factor->store(half.data(), out.data());
    Eigen::VectorXd x(b.size());
    for (int i = 0; i < x.size(); ++i) x[i] = out[4 * (i / 3) + i % 3];
    return x;
  }

  Eigen::RowVectorXd row(const LinearForm& form) const {
    Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(b.size());
    for (std::size_t k = 0; k < form.node.size(); ++k) result.segment<3>(3 * form.node[k]) += form.coefficient[k];
    return result;
  }

  // Forces of equality rows j with compliances c, in a system with the given inverse.
  static Eigen::VectorXd forcesOf(const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& j, const Eigen::VectorXd& c,
                                  const Eigen::VectorXd& b, const Eigen::VectorXd& rhs) {
    Eigen::MatrixXd compliance = j * inverse * j.transpose();
    compliance += c.asDiagonal();
    return compliance.ldlt().solve(rhs - j * inverse * b);
  }

  BlockMatrix matrix;
  Eigen::MatrixXd a, inverse;
  Eigen::VectorXd b, gas;
  std::unique_ptr<Factor> factor;
  ColumnCache columns;
  ConstraintSchur schur;
};

LinearForm form(std::vector<int> node, std::vector<Eigen::Vector3d> coefficient) {
  return {std::move(node), std::move(coefficient)};
}

constexpr double kTolerance = 2e-5;  // relative: vectors and columns are single precision

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

ConstraintRows twoEquations(double compliance) {
  ConstraintRows rows;
  rows.equations.push_back({form({3, 17, 40}, {{1, 0, 0}, {0.5, -1, 2}, {0, 0.3, 0}}), 0});
  rows.equations.push_back({form({17}, {{0, 0, 1}}), compliance});
  rows.number();
  return rows;
}

TEST(ConstraintSchur, EquationsWithComplianceAreThoseOfTheDenseSystem) {
  System system;
  const double compliance = 0.4;
  const ConstraintRows rows = twoEquations(compliance);
  system.schur.setRows(rows, *system.factor, system.columns);
  Eigen::MatrixXd j(2, system.b.size());
  j << system.row(rows.equations[0].form), system.row(rows.equations[1].form);
  const Eigen::Vector2d rhs(0.7, -1.3), c(0, compliance);
  const Eigen::VectorXd force = System::forcesOf(system.inverse, j, c, system.b, rhs);
  const Eigen::VectorXd x = system.solve(rhs);
  EXPECT_LT(difference(system.schur.forces(), force), kTolerance);
  EXPECT_LT(difference(x, system.inverse * (system.b + j.transpose() * force)), kTolerance);
  EXPECT_LT((j * x - (rhs - c.cwiseProduct(force))).norm(), 1e-4);
  EXPECT_LT(difference(system.schur.moves(), rhs - c.cwiseProduct(force)), kTolerance);
  // negative control: exact equations have other forces
  EXPECT_GT(difference(System::forcesOf(system.inverse, j, Eigen::Vector2d::Zero(), system.b, rhs), force), 0.05);
}

TEST(ConstraintSchur, ColumnsThatAreKeptGiveTheSameBitsAsNewOnes) {
  System system;
  system.schur.setRows(twoEquations(0.4), *system.factor, system.columns);
  const Eigen::Vector2d rhs(0.7, -1.3);
  const Eigen::VectorXd first = system.solve(rhs);
  ConstraintRows other;
  other.equations.push_back({form({5}, {{1, 0, 0}}), 0});
  system.schur.setRows(other, *system.factor, system.columns);
  EXPECT_GT((system.solve(Eigen::VectorXd::Constant(1, 2.0)) - first).norm(), 0.01) << "another row, another solution";
  system.schur.setRows(twoEquations(0.4), *system.factor, system.columns);
  EXPECT_EQ(system.solve(rhs), first);
}

struct TouchedNode {
  explicit TouchedNode(double friction) {
    ContactRows& contact = rows.contacts.add();
    const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, -1).normalized(), tangent = normal.unitOrthogonal();
    contact.form[0].setNode(29, normal);
    contact.form[1].setNode(29, tangent);
    contact.form[2].setNode(29, normal.cross(tangent));
    contact.friction = friction;
    rows.number();
    system.schur.setRows(rows, *system.factor, system.columns);
    j.resize(3, system.b.size());
    for (int k = 0; k < 3; ++k) j.row(k) = system.row(contact.form[k]);
    free = j * system.inverse * system.b;
  }
  System system;
  ConstraintRows rows;
  Eigen::MatrixXd j;
  Eigen::Vector3d free;  // values of the rows without contact
};

TEST(ConstraintSchur, AStickingContactIsThreeEquations) {
  TouchedNode touched(10);
  const Eigen::Vector3d rhs = touched.free + Eigen::Vector3d(1, 0.4, -0.3);
  const Eigen::VectorXd force =
      System::forcesOf(touched.system.inverse, touched.j, Eigen::Vector3d::Zero(), touched.system.b, rhs);
  ASSERT_LT(force.tail<2>().norm(), 10 * force[0]);
  const Eigen::VectorXd x = touched.system.solve(rhs);
  EXPECT_LT(difference(touched.system.schur.forces(), force), kTolerance);
  EXPECT_LT((touched.j * x - rhs).norm(), 1e-4);
}

TEST(ConstraintSchur, ASlidingContactIsOnTheConeAndItsFrictionOpposesTheSlide) {
  const double friction = 0.2;
  TouchedNode touched(friction);
  const Eigen::Vector3d rhs = touched.free + Eigen::Vector3d(1, 2, -1.5);
  const Eigen::VectorXd x = touched.system.solve(rhs), force = touched.system.schur.forces();
  EXPECT_LT(difference(x, touched.system.inverse * (touched.system.b + touched.j.transpose() * force)), kTolerance);
  EXPECT_NEAR((touched.j * x)[0], rhs[0], 1e-4);
  EXPECT_GT(force[0], 0.1);
  EXPECT_NEAR(force.tail<2>().norm(), friction * force[0], 1e-6);
  const Eigen::Vector2d left = (rhs - touched.j * x).tail<2>();  // minus the slip
  EXPECT_GT(left.norm(), 0.1) << "negative control: it sticks";
  EXPECT_GT(left.normalized().dot(force.tail<2>().normalized()), 1 - kTolerance);
  EXPECT_LT((touched.system.schur.moves() - touched.j * x).norm(), 1e-4);
  EXPECT_TRUE(touched.system.schur.holds(0));
  EXPECT_FALSE(touched.system.schur.holds(1));
}

TEST(ConstraintSchur, AContactNeverPulls) {
  TouchedNode touched(0.5);
  const Eigen::Vector3d rhs = touched.free + Eigen::Vector3d(-1, 2, -1.5);
  const Eigen::VectorXd x = touched.system.solve(rhs);
  EXPECT_TRUE(touched.system.schur.forces().isZero(0));
  EXPECT_LT(difference(x, touched.system.inverse * touched.system.b), kTolerance);
}

// Two segments between three points; turning costs nothing.
struct ThreeBites {
  explicit ThreeBites(double capstan, int guesses = ThreadSlides::kGuesses) : system(guesses) {
    RowList<AttachmentPoint> points{{{2, 3}, {0.5, 0.5}}, {{30}, {1}}, {{60, 61}, {0.3, 0.7}}};
    system.columns.setAttachments(*system.factor, points);
    ThreadRows& thread = rows.threads.add();
    const Eigen::Vector3d along[2] = {Eigen::Vector3d(1, 1, 0).normalized(), Eigen::Vector3d(0, 1, 1).normalized()};
    for (int k = 0; k < 2; ++k) {
      SegmentRows& segment = thread.segments.add();
      segment.along = along[k];
      segment.compliance = kCompliance;
      segment.turn_compliance = 1e12;
      segment.across = {along[k].unitOrthogonal(), along[k].cross(along[k].unitOrthogonal())};
      segment.capstan = capstan;
      for (int end = 0; end < 2; ++end)
        for (std::size_t i = 0; i < points[k + end].node.size(); ++i) {
          segment.pull.node.push_back(points[k + end].node[i]);
          segment.pull.coefficient.emplace_back((end == 0 ? 1 : -1) * points[k + end].weight[i] * along[k]);
        }
      segment.turn = {segment.pull, segment.pull};
      segment.spare = 100;
    }
    rows.number();
    system.schur.setRows(rows, *system.factor, system.columns);
    j.resize(2, system.b.size());
    for (int k = 0; k < 2; ++k) j.row(k) = system.row(thread.segments[k].pull);
    free = j * system.inverse * system.b;
  }
  Eigen::VectorXd rhs(double first, double second) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(6);
    all.head<2>() = free + Eigen::Vector2d(first, second);
    return all;
  }
  static constexpr double kCompliance = 0.05;
  System system;
  ConstraintRows rows;
  Eigen::MatrixXd j;
  Eigen::Vector2d free;
};

TEST(ConstraintSchur, AThreadWithoutFrictionSlidesUntilItsTensionsAreEqual) {
  ThreeBites bites(1);
  const Eigen::VectorXd rhs = bites.rhs(1.0, 0.2);
  const Eigen::VectorXd x = bites.system.solve(rhs), force = bites.system.schur.forces();
  // one row that is the sum of both
  const Eigen::MatrixXd whole = bites.j.row(0) + bites.j.row(1);
  const Eigen::VectorXd expected =
      System::forcesOf(bites.system.inverse, whole, Eigen::VectorXd::Constant(1, 2 * ThreeBites::kCompliance),
                       bites.system.b, Eigen::VectorXd::Constant(1, rhs[0] + rhs[1]));
  EXPECT_NEAR(force[0], expected[0], 1e-4 * expected[0]);
  EXPECT_NEAR(force[1], expected[0], 1e-4 * expected[0]);
  const double slid = bites.system.schur.lost()[0];
  EXPECT_GT(std::abs(slid), 0.01);
  EXPECT_NEAR((bites.j * x)[0], rhs[0] + slid - ThreeBites::kCompliance * force[0], 1e-4);
  EXPECT_NEAR((bites.j * x)[1], rhs[1] - slid - ThreeBites::kCompliance * force[1], 1e-4);
}

TEST(ConstraintSchur, WhereFrictionHoldsTheThreadItsSegmentsAreTwoEquations) {
  ThreeBites bites(1e4);
  const Eigen::VectorXd rhs = bites.rhs(1.0, 0.8);
  bites.system.solve(rhs);
  const Eigen::VectorXd expected = System::forcesOf(
      bites.system.inverse, bites.j, Eigen::Vector2d::Constant(ThreeBites::kCompliance), bites.system.b, rhs.head<2>());
  ASSERT_GT(expected.minCoeff(), 0);
  EXPECT_LT(difference(bites.system.schur.forces().head<2>(), expected), 1e-4);
  EXPECT_NEAR(bites.system.schur.lost()[0], 0, 1e-9);
  EXPECT_GT(std::abs(expected[0] / expected[1] - 1), 0.01) << "negative control: equal tensions show no friction";
}

TEST(ConstraintSchur, ASlidingThreadHasTheCapstanRatioUntilItIsHeld) {
  const double capstan = 1.3;
  ThreeBites bites(capstan);
  const Eigen::VectorXd rhs = bites.rhs(2.0, 0.1);
  bites.system.solve(rhs);
  const Eigen::VectorXd force = bites.system.schur.forces();
  EXPECT_NEAR(std::max(force[0] / force[1], force[1] / force[0]), capstan, 1e-4);
  bites.system.schur.holdThreads(true);
  bites.system.solve(rhs);
  EXPECT_NEAR(bites.system.schur.lost()[0], 0, 1e-9);
  EXPECT_GT(std::abs(bites.system.schur.forces()[0] - force[0]), 1e-3 * force[0]);
}

TEST(ConstraintSchur, AThreadWhoseGuessDoesNotEndIsAViolation) {
  ThreeBites found(1.3), missed(1.3, 1);
  found.system.solve(found.rhs(2.0, 0.1));
  missed.system.solve(missed.rhs(2.0, 0.1));
  EXPECT_LT(found.system.schur.violation(), 1e-6);
  EXPECT_GT(missed.system.schur.violation(), 1e-2);
  EXPECT_GE(missed.system.schur.forces().head<2>().minCoeff(), 0);
}

TEST(ConstraintSchur, ASlackThreadDoesNotPush) {
  ThreeBites bites(1.3);
  const Eigen::VectorXd x = bites.system.solve(bites.rhs(-1, -2));
  EXPECT_LT(bites.system.schur.forces().cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(difference(x, bites.system.inverse * bites.system.b), kTolerance);
}

TEST(ConstraintSchur, GasIsAMatrixOfRankOne) {
  System system;
  const double stiffness = 0.05;
  const ConstraintRows rows = twoEquations(0.4);
  system.schur.setRows(rows, *system.factor, system.columns);
  system.schur.setGas(system.four(system.gas).data(), stiffness, *system.factor);
  const Eigen::MatrixXd inverse = (system.a + stiffness * system.gas * system.gas.transpose()).inverse();
  Eigen::MatrixXd j(2, system.b.size());
  j << system.row(rows.equations[0].form), system.row(rows.equations[1].form);
  const Eigen::Vector2d rhs(0.7, -1.3), c(0, 0.4);
  const Eigen::VectorXd force = System::forcesOf(inverse, j, c, system.b, rhs);
  const Eigen::VectorXd x = system.solve(rhs);
  EXPECT_LT(difference(system.schur.forces(), force), 1e-4);
  EXPECT_LT(difference(x, inverse * (system.b + j.transpose() * force)), 1e-4);
  EXPECT_NEAR(system.schur.gasForce(), -stiffness * system.gas.dot(x), 1e-3 * std::abs(system.schur.gasForce()));
  for (const int threads : {2, 3, 5}) {
    ThreadPool pool(threads);
    system.schur.use(pool);
    system.schur.setGas(system.four(system.gas).data(), stiffness, *system.factor);
    EXPECT_EQ(system.solve(rhs), x) << threads << " threads";
  }
  ThreadPool single;
  system.schur.use(single);
  // negative control: the gas has an effect, and is gone when it is taken away
  EXPECT_GT(difference(system.inverse * system.b, inverse * system.b), 0.01);
  system.schur.setGas(nullptr, 0, *system.factor);
  system.solve(rhs);
  EXPECT_LT(difference(system.schur.forces(), System::forcesOf(system.inverse, j, c, system.b, rhs)), kTolerance);
}

TEST(ConstraintSchur, APrescribedVolumeIsAnEquation) {
  System system;
  system.schur.setRows({}, *system.factor, system.columns);
  system.schur.setGas(system.four(system.gas).data(), std::numeric_limits<double>::infinity(), *system.factor);
  const double swelling = 0.7;
  const Eigen::VectorXd x = system.solve(Eigen::VectorXd(), swelling);
  EXPECT_NEAR(system.gas.dot(x), swelling, 1e-3);
  const Eigen::VectorXd force = System::forcesOf(system.inverse, system.gas.transpose(), Eigen::VectorXd::Zero(1),
                                                 system.b, Eigen::VectorXd::Constant(1, swelling));
  EXPECT_NEAR(system.schur.gasForce(), force[0], 1e-4 * std::abs(force[0]));
}

}  // namespace
}  // namespace vibe::constraint_schur_test
