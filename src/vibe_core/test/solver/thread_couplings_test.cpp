// Springs across tense threads in the factor: their stiffness, and when a row is still needed.
#include "solver/couplings.hpp"

#include <gtest/gtest.h>

#include "solver/implicit_worlds.hpp"
#include "solver/step_rows.hpp"

namespace vibe::thread_couplings_test {
namespace {

using namespace test;

struct Fixture {
  Fixture() : body(block({3, 1, 1}, neoHookean())), stepper(body, {}), motion(body), scratch(stepper.makeWorkspace()) {
    loads.attachments = {{{0, 1, 2}, {0.2, 0.5, 0.3}}, {{8, 9, 10}, {0.5, 0.25, 0.25}}, {{15}, {1}}};
    ThreadLoad thread;
    thread.length = {0.02, 0.015};
    thread.stiffness = 300;
    thread.tension = {2, 1e-3};
    loads.threads.push_back(thread);
    for (int i = 0; i < body.nodeCount(); ++i)
      for (int k = 0; k < 4; ++k) positions.push_back(k < 3 ? body.rest[i][k] : 0);
    buildRows(loads, motion.view(), scratch->system);
  }
  const SegmentRows& segment(std::size_t k) const { return scratch->system.rows.threads[0].segments[k]; }
  void find(const std::vector<StiffnessCoupling>& in_factor) {
    findMissingTurns(loads, in_factor, scratch->system.rows);
  }
  ElasticBody body;
  ImplicitStepper stepper;
  BodyMotion motion;
  std::shared_ptr<StepperWorkspace> scratch;
  BodyLoads loads;
  std::vector<double> positions;
};

TEST(ThreadCouplings, AreTheSpringsAcrossTenseSegments) {
  Fixture fixture;
  std::vector<StiffnessCoupling> couplings;
  addThreadCouplings(fixture.loads, fixture.positions.data(), 2, couplings);
  ASSERT_EQ(couplings.size(), 1u) << "the other segment is slack";
  const StiffnessCoupling& c = couplings[0];
  const SegmentRows& segment = fixture.segment(0);
  // x . K x of the coupling and of the springs, for some motion
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  double springs = 0;
  std::vector<double> x(fixture.positions.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = i % 4 == 3 ? 0 : std::sin(3.0 * static_cast<double>(i));
  for (std::size_t i = 0; i < 6; ++i)
    turned += c.weight[i] * Eigen::Vector3d(&x[4 * static_cast<std::size_t>(c.node[i])]);
  for (const LinearForm& turn : segment.turn)
    springs += turn.value(x) * turn.value(x) / (2 * segment.turn_compliance);  // a gain of 2
  Eigen::Matrix3d k;
  k << c.stiffness[0], c.stiffness[1], c.stiffness[2], c.stiffness[1], c.stiffness[3], c.stiffness[4], c.stiffness[2],
      c.stiffness[4], c.stiffness[5];
  EXPECT_NEAR(turned.dot(k * turned), springs, 1e-5 * springs);
  EXPECT_GT(springs, 1);
}

TEST(ThreadCouplings, ARowHasWhatTheFactorLacks) {
  Fixture fixture;
  std::vector<StiffnessCoupling> couplings;
  fixture.find({});
  const double all = fixture.segment(0).turn_compliance;
  EXPECT_DOUBLE_EQ(fixture.segment(0).turn_missing, all);
  EXPECT_EQ(fixture.segment(1).turn_missing, 0) << "slack";
  addThreadCouplings(fixture.loads, fixture.positions.data(), 1, couplings);
  fixture.find(couplings);
  EXPECT_EQ(fixture.segment(0).turn_missing, 0);
  for (float& entry : couplings[0].stiffness) entry *= 0.5F;
  fixture.find(couplings);
  EXPECT_NEAR(fixture.segment(0).turn_missing, 2 * all, 1e-5 * all);
  couplings[0].node[0] = 5;
  fixture.find(couplings);
  EXPECT_DOUBLE_EQ(fixture.segment(0).turn_missing, all) << "another bite";
}

}  // namespace
}  // namespace vibe::thread_couplings_test
