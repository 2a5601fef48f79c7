// Iterations towards the minimum of an energy. The body is (almost) nothing but springs to its rest position, so that
// the energy is quadratic and the minimum is known.
#include "solver/quasi_newton.hpp"

#include <gtest/gtest.h>

#include "solver/implicit_worlds.hpp"
#include "solver/step_rows.hpp"
#include "solver/stepper_workspace.hpp"
#include "vibe_core/solver/energy_term.hpp"

namespace vibe::quasi_newton_test {
namespace {

using namespace test;

constexpr double kSpring = 50;  // [N/m]
constexpr double kFar = 1;      // no limit of a move [m]

ElasticBody springs(double at_some_nodes = 1) {
  ElasticBody body = block({2, 2, 2}, {Law::NeoHookean, 1e-6, kNu, 0});
  body.foundation.assign(body.rest.size(), kSpring);
  for (const int node : {1, 5, 11, 19}) body.foundation[node] *= 1 + (at_some_nodes - 1) * (1 + 0.1 * node);
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    body.load.push_back(Eigen::Vector3d(0.02 + 1e-3 * static_cast<double>(i), 0.01, -0.03));
  return body;
}

struct Problem {
  /// @param factored  the body that the factor is made for
  explicit Problem(const ElasticBody& factored)
      : body(springs()), stepper(body, {}, FactorStorage::Double), scratch(stepper.makeWorkspace()), motion(body) {
    EXPECT_TRUE(factorAt(factored, {}, 0, 1, scratch->factors.matrix, *scratch->factors.current));
    scratch->system.schur.reset(*scratch->factors.current);
    for (int i = 0; i < body.nodeCount(); ++i)
      for (int k = 0; k < 3; ++k) scratch->iterate.z[4 * i + k] = body.rest[i][k];
  }
  void setLoads() {
    buildRows(loads, motion.view(), scratch->system);
    setEquilibriumTargets(loads, scratch->iterate.z, scratch->system);
    scratch->system.schur.setRows(scratch->system.rows, *scratch->factors.current, scratch->factors.columns);
  }
  double errorAt(int node) const {
    const Eigen::Vector3d expected = body.rest[node] + body.load[node] / kSpring;
    return (Eigen::Vector3d(&scratch->iterate.z[4 * node]) - expected).norm();
  }
  double maxError() const {
    double max = 0;
    for (int i = 0; i < body.nodeCount(); ++i) max = std::max(max, errorAt(i));
    return max;
  }
  ElasticBody body;
  ImplicitStepper stepper;
  std::shared_ptr<StepperWorkspace> scratch;
  BodyMotion motion;
  BodyLoads loads;
};

TEST(QuasiNewton, TheExactFactorOfAQuadraticLeadsThereInOneIteration) {
  Problem problem(springs());
  problem.setLoads();
  Potential potential(problem.body, problem.loads, 0, *problem.scratch);
  QuasiNewton newton(problem.body, potential, problem.loads, *problem.scratch);
  newton.takeRows();
  EXPECT_GT(problem.maxError(), 5e-4) << "negative control: it starts at the solution";
  newton.start();
  EXPECT_GT(newton.iterate(kFar, true), 5e-4);
  EXPECT_FALSE(newton.failed());
  EXPECT_LT(problem.maxError(), 1e-8);
  newton.iterate(kFar, true);
  EXPECT_LT(newton.directionLength(), 1e-7);
}

// @returns lengths of the directions
std::vector<double> lengths(bool with_history, int iterations) {
  Problem problem(springs(3));
  problem.setLoads();
  Potential potential(problem.body, problem.loads, 0, *problem.scratch);
  QuasiNewton newton(problem.body, potential, problem.loads, *problem.scratch);
  newton.takeRows();
  newton.start();
  std::vector<double> result;
  for (int i = 0; i < iterations; ++i) {
    if (!with_history) newton.restart();
    newton.iterate(kFar, true);
    result.push_back(newton.directionLength());
  }
  return result;
}

// Superlinear: the contraction of the last five iterations is stronger than that of the factor alone by an order.
TEST(QuasiNewton, AStaleFactorIsMadeUpForByTheHistory) {
  const std::vector<double> fast = lengths(true, 16), slow = lengths(false, 16);
  EXPECT_LT(fast[15], 1e-4 * fast[0]);
  EXPECT_LT(fast[15] / fast[10], 0.1 * slow[15] / slow[10]);
  // negative control: without the history the contraction is that of the factor's worst node, (1 - 1 / ratio)
  const double ratio = 1 + 2 * (1 + 0.1 * 19);
  EXPECT_NEAR(slow[15] / slow[14], 1 - 1 / ratio, 0.01);
}

TEST(QuasiNewton, AMoveIsShortenedToTheLongestAllowed) {
  Problem problem(springs());
  problem.setLoads();
  Potential potential(problem.body, problem.loads, 0, *problem.scratch);
  QuasiNewton newton(problem.body, potential, problem.loads, *problem.scratch);
  newton.takeRows();
  newton.start();
  EXPECT_NEAR(newton.iterate(1e-4, true), 1e-4, 1e-9);
  EXPECT_FALSE(newton.contracts());
}

// Its gradient points the wrong way: downhill by the gradient is uphill in energy.
class Liar : public EnergyTerm {
 public:
  double evaluate(const double* z, float* gradient4) const override {
    gradient4[0] += 1000;
    return -1000 * z[0] + 1e9 * z[0] * z[0];
  }
};

TEST(QuasiNewton, ADirectionWithoutLowerEnergyIsReportedAndNotTaken) {
  Problem problem(springs());
  problem.setLoads();
  const Liar liar;
  problem.loads.extra = &liar;
  Potential potential(problem.body, problem.loads, 0, *problem.scratch);
  QuasiNewton newton(problem.body, potential, problem.loads, *problem.scratch);
  newton.takeRows();
  newton.start();
  const StepperWorkspace& scratch = *problem.scratch;
  const std::vector<double> before = scratch.iterate.z;
  const std::vector<float> displacement = scratch.iterate.last.displacement,
                           elastic = scratch.iterate.last.elastic_gradient;
  const double energy = scratch.iterate.last.elastic_value;
  EXPECT_EQ(newton.iterate(kFar, true), 0);
  EXPECT_TRUE(newton.failed());
  EXPECT_EQ(scratch.iterate.z, before);
  // forces and works of the step are those at z, not those of the trial that was rejected
  EXPECT_EQ(scratch.iterate.last.displacement, displacement);
  EXPECT_EQ(scratch.iterate.last.elastic_gradient, elastic);
  EXPECT_EQ(scratch.iterate.last.elastic_value, energy);
}

TEST(QuasiNewton, AConstraintIsMetAtTheMinimum) {
  Problem problem(springs());
  const int node = 4;
  problem.loads.addPoint({node}, {1}, problem.body.rest[node] + Eigen::Vector3d(0, 0, 2e-3), 0);
  problem.setLoads();
  Potential potential(problem.body, problem.loads, 0, *problem.scratch);
  QuasiNewton newton(problem.body, potential, problem.loads, *problem.scratch);
  newton.takeRows();
  newton.start();
  for (int i = 0; i < 3; ++i) newton.iterate(kFar, true);
  storeForces(problem.scratch->system, 1, problem.loads);
  EXPECT_NEAR(problem.scratch->iterate.z[4 * node + 2], problem.body.rest[node].z() + 2e-3, 1e-8);
  EXPECT_NEAR(problem.loads.pointForce(0).z(), kSpring * 2e-3 - problem.body.load[node].z(), 1e-5);
  EXPECT_LT(problem.errorAt(0), 1e-7) << "other nodes do not feel it";
}

}  // namespace
}  // namespace vibe::quasi_newton_test
