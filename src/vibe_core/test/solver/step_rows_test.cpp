// Loads as rows: their order, directions and targets, and the way of the forces back.
#include "solver/step_rows.hpp"

#include <gtest/gtest.h>

#include "solver/implicit_worlds.hpp"
#include "solver/stepper_workspace.hpp"
#include "suture/capstan.hpp"

namespace vibe::step_rows_test {
namespace {

using namespace test;

struct Fixture {
  Fixture() : body(block({2, 1, 1}, neoHookean())), stepper(body, {}), motion(body), scratch(stepper.makeWorkspace()) {
    loads.addPoint({1, 2}, {0.25, 0.75}, {0.1, 0.2, 0.3}, 0.02);
    const Eigen::Vector3d normal = Eigen::Vector3d(0, 3, 4) / 5;
    ContactConstraint contact;
    contact.point = SurfacePoint::ofNode(3);
    contact.normal = normal;
    contact.offset = 0.7;
    contact.friction = 0.3;
    contact.anchor = {0.01, 0.02, 0.03};
    loads.contacts.push_back(contact);
    loads.attachments = {{{0}, {1}}, {{4, 5}, {0.5, 0.5}}, {{7}, {1}}};
    ThreadLoad thread;
    thread.length = {0.02, 0.015};
    thread.stiffness = 300;
    thread.friction = 0.15;
    thread.tension = {2, 0};
    loads.threads.push_back(thread);
    buildRows(loads, motion.view(), scratch->system);
  }
  Eigen::Vector3d place(int attachment) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const AttachmentPoint& point = loads.attachments[static_cast<std::size_t>(attachment)];
    for (std::size_t i = 0; i < point.node.size(); ++i) sum += point.weight[i] * body.rest[point.node[i]];
    return sum;
  }
  std::vector<double> four(const BodyMotion& of) const {
    std::vector<double> z;
    for (int i = 0; i < body.nodeCount(); ++i) z.insert(z.end(), {of.x[0][i], of.x[1][i], of.x[2][i], 0});
    return z;
  }
  ElasticBody body;
  ImplicitStepper stepper;
  BodyMotion motion;
  std::shared_ptr<StepperWorkspace> scratch;
  BodyLoads loads;
};

TEST(StepRows, AreNumberedEquationsContactsThreads) {
  Fixture fixture;
  const ConstraintRows& rows = fixture.scratch->system.rows;
  EXPECT_EQ(rows.count(), 3 + 3 + 6);
  EXPECT_EQ(rows.contactRow(0), 3);
  ASSERT_EQ(rows.threads.size(), 1u);
  EXPECT_EQ(rows.threads[0].pullRow(1), 7);
  EXPECT_EQ(rows.threads[0].turnRow(1, 1), 11);
  std::vector<int> order;
  rows.forEachMultiplier([&order](int row, const LinearForm&) { order.push_back(row); });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  order.clear();
  rows.forEachSpring([&order](int row, const LinearForm&, double) { order.push_back(row); });
  EXPECT_EQ(order, (std::vector<int>{8, 9, 10, 11}));
  // negative control: without loads there is nothing
  buildRows({}, fixture.motion.view(), fixture.scratch->system);
  EXPECT_EQ(rows.count(), 0);
}

TEST(StepRows, AContactHasItsNormalAndTwoTangents) {
  Fixture fixture;
  const ContactRows& contact = fixture.scratch->system.rows.contacts[0];
  Eigen::Matrix3d frame;
  for (int k = 0; k < 3; ++k) frame.col(k) = contact.form[static_cast<std::size_t>(k)].coefficient[0];
  EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_EQ(frame.col(0), fixture.loads.contacts[0].normal);
  EXPECT_EQ(contact.friction, 0.3);
}

TEST(StepRows, TheDeepestContactsCountWhereThereAreTooMany) {
  Fixture fixture;
  StepperWorkspace& scratch = *fixture.scratch;
  const ContactConstraint first = fixture.loads.contacts[0];
  fixture.loads.contacts.clear();
  constexpr int kCount = 150;
  for (int i = 0; i < kCount; ++i) {
    fixture.loads.contacts.push_back(first);
    fixture.loads.contacts.back().offset = 1e-5 * ((7 * i) % kCount);
  }
  scratch.iterate.z = fixture.four(fixture.motion);
  buildRows(fixture.loads, fixture.motion.view(), scratch.system);
  setEquilibriumTargets(fixture.loads, scratch.iterate.z, scratch.system);
  ASSERT_EQ(scratch.system.rows.counted, 128);
  for (int i = 0; i < kCount; ++i) {
    const ContactRows& contact = scratch.system.rows.contacts[i];
    const int deeper = kCount - 1 - static_cast<int>(7 * contact.load) % kCount;
    EXPECT_EQ(contact.friction, deeper < 32 ? first.friction : 0) << deeper;
    EXPECT_EQ(i < 128, deeper < 128) << deeper;
    EXPECT_TRUE(i == 0 || i >= 128 || scratch.system.rows.contacts[i - 1].load < contact.load) << i;
  }
  ASSERT_TRUE(factorAt(fixture.body, {}, 3600, 1, scratch.factors.matrix, *scratch.factors.current));
  scratch.system.schur.reset(*scratch.factors.current);
  scratch.factors.columns.setAttachments(*scratch.factors.current, fixture.loads.attachments);
  scratch.system.schur.setRows(scratch.system.rows, *scratch.factors.current, scratch.factors.columns);
  scratch.system.rhs.setZero();
  for (int i = 0; i < 128; ++i) scratch.system.rhs[scratch.system.rows.contactRow(i)] = 1e-3;
  scratch.system.schur.eliminate(scratch.system.rhs, 0, scratch.iterate.half.data());
  EXPECT_LT(scratch.system.schur.violation(), 1e-8);
  double pushing = 0;
  for (int i = 0; i < 128; ++i) pushing += scratch.system.schur.forces()[scratch.system.rows.contactRow(i)];
  EXPECT_GT(pushing, 1e-3);
  scratch.system.unknowns.begin(scratch.system.rows);
  storeForces(scratch.system, 1, fixture.loads);
  for (int i = 0; i < kCount; ++i) {
    const ContactRows& contact = scratch.system.rows.contacts[i];
    const double row_force = i < 128 ? scratch.system.schur.forces()[scratch.system.rows.contactRow(i)] : 0;
    EXPECT_NEAR(fixture.loads.contacts[contact.load].force.dot(first.normal), row_force, 1e-12);
  }
}

TEST(StepRows, ASegmentPullsAlongItselfAndResistsTurning) {
  Fixture fixture;
  const ThreadRows& thread = fixture.scratch->system.rows.threads[0];
  const Eigen::Vector3d between = fixture.place(1) - fixture.place(0);
  const SegmentRows& segment = thread.segments[0];
  EXPECT_LT((segment.along - between.normalized()).norm(), 1e-14);
  EXPECT_NEAR(segment.pull.value(fixture.four(fixture.motion)), -between.norm(), 1e-14) << "minus its length";
  EXPECT_DOUBLE_EQ(segment.compliance, 0.02 / 300);
  EXPECT_DOUBLE_EQ(segment.turn_compliance, between.norm() / 2);
  for (const LinearForm& turn : segment.turn) EXPECT_NEAR(turn.value(fixture.four(fixture.motion)), 0, 1e-14);
  EXPECT_DOUBLE_EQ(segment.capstan,
                   capstanFactor(0.15, turningAngle(fixture.place(0), fixture.place(1), fixture.place(2))));
  EXPECT_GT(thread.segments[1].turn_compliance, 1e3) << "a slack segment turns freely";
}

TEST(StepRows, TargetsOfAnEquilibriumAreThoseOfTheLoads) {
  Fixture fixture;
  setEquilibriumTargets(fixture.loads, fixture.scratch->iterate.z, fixture.scratch->system);
  const Eigen::VectorXd& target = fixture.scratch->system.target;
  EXPECT_EQ(Eigen::Vector3d(target.head<3>()), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(target[3], 0.7);
  const ContactRows& contact = fixture.scratch->system.rows.contacts[0];
  EXPECT_EQ(target[4], contact.form[1].coefficient[0].dot(fixture.loads.contacts[0].anchor));
  EXPECT_EQ(target[6], -0.02);
  EXPECT_TRUE(target.tail<4>().isZero(0));
}

// If z meets the target of the step, the position that the scheme makes of it meets that of the load.
TEST(StepRows, TargetsOfAStepAreMetAtItsEnd) {
  Fixture fixture;
  for (int i = 0; i < fixture.body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) fixture.motion.v[k][i] = 0.1 * (k + 1) + 0.01 * i, fixture.motion.a[k][i] = 2.0 * k - i;
  const TimeScheme scheme(fixture.stepper.settings(), 1.5, 0.01);
  setStepTargets(fixture.loads, fixture.motion.view(), scheme, {}, fixture.scratch->iterate.z, fixture.scratch->system);
  const LinearForm& form = fixture.scratch->system.rows.equations[0].form;
  const double target = fixture.scratch->system.target[0];
  // one acceleration for all nodes, such that z is at the target
  BodyMotion z = fixture.motion, end = fixture.motion;
  const auto place = [&](double acceleration) {
    for (int i = 0; i < fixture.body.nodeCount(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double x = fixture.motion.x[k][i], v = fixture.motion.v[k][i], a = fixture.motion.a[k][i];
        z.x[k][i] = scheme.free_z(x, v, a) + scheme.z_gain * acceleration;
        end.x[k][i] = scheme.free_x(x, v, a) + scheme.x_gain * acceleration;
      }
    return form.value(fixture.four(z));
  };
  const double at_zero = place(0), per_unit = (place(1) - at_zero);
  EXPECT_NEAR(place((target - at_zero) / per_unit), target, 1e-12);
  EXPECT_NEAR(form.value(fixture.four(end)), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(fixture.scratch->system.rows.equations[0].compliance, 0.02 * scheme.z_gain / scheme.x_gain);
  EXPECT_GT(std::abs(target - 0.1), 1e-6) << "negative control: the two targets are the same";
}

TEST(StepRows, ForcesComeBackToTheLoads) {
  Fixture fixture;
  StepperWorkspace& scratch = *fixture.scratch;
  setEquilibriumTargets(fixture.loads, scratch.iterate.z, scratch.system);
  ASSERT_TRUE(factorAt(fixture.body, {}, 3600, 1, scratch.factors.matrix, *scratch.factors.current));
  scratch.system.schur.reset(*scratch.factors.current);
  scratch.factors.columns.setAttachments(*scratch.factors.current, fixture.loads.attachments);
  scratch.system.schur.setRows(scratch.system.rows, *scratch.factors.current, scratch.factors.columns);
  scratch.system.rhs.setConstant(1e-3);
  scratch.system.rhs.tail<4>().setZero();
  scratch.system.schur.eliminate(scratch.system.rhs, 0, scratch.iterate.half.data());
  scratch.system.unknowns.begin(scratch.system.rows);
  scratch.system.unknowns.lose(6, 2e-3);
  scratch.system.unknowns.lose(7, -2e-3);
  storeForces(scratch.system, 2, fixture.loads);
  const Eigen::VectorXd& force = scratch.system.schur.forces();
  ASSERT_GT(force.head<8>().cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(fixture.loads.pointForce(0), Eigen::Vector3d(force.head<3>()));
  EXPECT_NEAR(fixture.loads.contacts[0].force.norm(), force.segment<3>(3).norm(), 1e-12);
  EXPECT_EQ(fixture.loads.threads[0].tension, (std::vector<double>{force[6], force[7]}));
  EXPECT_DOUBLE_EQ(fixture.loads.threads[0].length[0], 0.02 - 1e-3);
  EXPECT_DOUBLE_EQ(fixture.loads.threads[0].length[1], 0.015 + 1e-3);
}

TEST(StepRows, AsMuchThreadAsAFoldNeedsStaysBetweenTwoBites) {
  Fixture fixture;
  StepperWorkspace& scratch = *fixture.scratch;
  scratch.system.unknowns.begin(scratch.system.rows);
  ASSERT_TRUE(factorAt(fixture.body, {}, 3600, 1, scratch.factors.matrix, *scratch.factors.current));
  scratch.system.schur.reset(*scratch.factors.current);
  scratch.factors.columns.setAttachments(*scratch.factors.current, fixture.loads.attachments);
  scratch.system.schur.setRows(scratch.system.rows, *scratch.factors.current, scratch.factors.columns);
  scratch.system.unknowns.lose(6, 0.018);
  scratch.system.unknowns.lose(7, -0.018);
  storeForces(scratch.system, 1, fixture.loads);
  EXPECT_DOUBLE_EQ(fixture.loads.threads[0].length[0], kMinThread);
  EXPECT_NEAR(fixture.loads.threads[0].length[1], 0.035 - kMinThread, 1e-15) << "the sum stays";
}

}  // namespace
}  // namespace vibe::step_rows_test
