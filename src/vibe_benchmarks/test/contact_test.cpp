// The instruments of vibe_contact: what they measure is checked with motions and states that are known.
#include <gtest/gtest.h>

#include <sstream>

#include "contact/bench_tools.hpp"
#include "contact/contact_run.hpp"
#include "contact/contact_table.hpp"
#include "contact_scene.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks::contact_test {
namespace {

using test::coarseStomach;
using test::scopeUrdf;

/// Frames of one particle on a line, and forces along x.
ContactTrace traceOf(const std::vector<double>& places, const std::vector<double>& forces) {
  ContactTrace trace;
  for (const double x : places) trace.frames.push_back({{{x}, {0}, {0}}});
  for (const double force : forces) trace.force.emplace_back(force, 0, 0);
  return trace;
}

TEST(Contact, ErrorsAreThoseOfTheWorstFrameOverTheReference) {
  const ContactTrace reference = traceOf({0, 1, 2, 4, 4, 4, 4, 4}, {9, 1, 2, 3, 4, 5, 10});
  const ContactTrace other = traceOf({0, 1, 2.2, 4, 4, 4, 4, 4.1}, {0, 1, 2, 3, 4, 5.5, 10.2});
  const ContactErrors errors = compareContact(other, reference);
  EXPECT_NEAR(errors.motion, 0.2 / 4, 1e-12);
  EXPECT_NEAR(errors.motion_end, 0.1 / 4, 1e-12);
  EXPECT_NEAR(errors.force, 0.5 / 10, 1e-12);  // the error of 9 N is before the sixth frame
  EXPECT_NEAR(errors.force_end, 0.2 / 10, 1e-12);
  EXPECT_EQ(errors.largest, 10);
  const ContactErrors none = compareContact(reference, reference);
  EXPECT_EQ(none.motion + none.motion_end + none.force + none.force_end, 0);
}

TEST(Contact, TheFreeHandHoldsWhereAndMovesAsItIsTold) {
  Scene scene;
  const Eigen::Vector3d tip(0.1, -0.2, 0.3), direction = Eigen::Vector3d(1, 2, -2) / 3;
  holdByHand(tip, direction, scene);
  const ToolModel hand = ToolModel::fromUrdf(freeHandUrdf(), "hand");
  EXPECT_TRUE(hand.shapes().empty());
  const Eigen::Isometry3d base = Eigen::Translation3d(scene.scope->base_position) *
                                 Eigen::AngleAxisd(scene.scope->base_rpy[2], Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(scene.scope->base_rpy[1], Eigen::Vector3d::UnitY());
  std::array<double, kJointCount> joints{};
  std::vector<Eigen::Isometry3d> poses;
  const auto helix = static_cast<std::size_t>(hand.linkIndex("helix"));
  joints[Insertion] = kHandStart;
  hand.forwardKinematics(joints, poses);
  EXPECT_LT((base * poses[helix].translation() - tip).norm(), 1e-12);
  joints[Insertion] += 0.02;
  hand.forwardKinematics(joints, poses);
  EXPECT_LT((base * poses[helix].translation() - tip - 0.02 * direction).norm(), 1e-12);
}

TEST(Contact, JointLimitsChangeOnlyThoseOfOneJoint) {
  const JointLimits wide{-1, 2, 3};
  const ToolModel before = ToolModel::fromUrdf(scopeUrdf(), "scope");
  const ToolModel after = ToolModel::fromUrdf(withJointLimits(scopeUrdf(), "insertion", wide), "scope");
  EXPECT_EQ(after.limits()[Insertion].lower, -1);
  EXPECT_EQ(after.limits()[Insertion].upper, 2);
  EXPECT_EQ(after.limits()[Insertion].velocity, 3);
  EXPECT_EQ(after.limits()[Rotation].velocity, before.limits()[Rotation].velocity);
  EXPECT_THROW(withJointLimits(scopeUrdf(), "elbow", wide), Error);
}

TEST(Contact, APullAtHigherRatesIsNearerToTheReference) {
  std::ostringstream log;
  ContactPlan plan;
  plan.names = {"free"};
  plan.settings = {{60, 4, 0.2}, {240, 4, 0.2}, {240, 4, 0.2, false, 2}};
  plan.reference = ContactSetting{960, 4, 0.2};
  plan.repeats = 2;  // throws if the bits differ
  const auto rows = runContactStates(coarseStomach(), scopeUrdf(), plan, log);
  ASSERT_EQ(rows.size(), 3u);
  for (const ContactRow& row : rows) {
    ASSERT_TRUE(row.errors);
    EXPECT_EQ(row.name, "free");
    EXPECT_EQ(row.ratio, 1);
    EXPECT_GT(row.errors->largest, 0.5);  // [N]
    EXPECT_LT(row.errors->motion, 0.1);
    EXPECT_LT(row.errors->motion_end, 0.03);
    EXPECT_EQ(row.trace.contacts, 0);
    EXPECT_EQ(row.trace.crossings, 0);
    EXPECT_EQ(row.trace.events, 0);
    EXPECT_GT(row.times.p50, 0);
    EXPECT_GT(row.wall.max, 0.99 * row.times.max);
    EXPECT_GT(row.trace.others, 0);  // makes factors
    EXPECT_GE(row.trace.iterations, 1);
  }
  EXPECT_LT(rows[1].errors->motion, 0.5 * rows[0].errors->motion);
  EXPECT_LT(rows[1].errors->force, 0.5 * rows[0].errors->force);
  EXPECT_EQ(rows[2].trace.hash, rows[1].trace.hash);
  std::ostringstream csv;
  writeContactRows(rows, csv);
  const std::string text = csv.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
  const auto fields = std::count(text.begin(), text.begin() + static_cast<long>(text.find('\n')), ',');
  EXPECT_EQ(std::count(text.begin(), text.end(), ','), 4 * fields);
}

TEST(Contact, OfTwoRunsTheShorterTimeOfEachStepCounts) {
  ContactTrace trace, other;
  trace.cpu = {1, 4}, trace.wall = {5, 2}, trace.others = 7;
  other.cpu = {2, 3}, other.wall = {4, 3}, other.others = 8;
  takeFaster(other, trace);
  EXPECT_EQ(trace.cpu, (std::vector<double>{1, 3}));
  EXPECT_EQ(trace.wall, (std::vector<double>{4, 2}));
  EXPECT_EQ(trace.others, 7);
  other.hash = 1;
  EXPECT_THROW(takeFaster(other, trace), Error);
}

TEST(Contact, ThePressedStateTouchesAndTheCinchedOneIsDrawn) {
  std::ostringstream log;
  ContactStates states(coarseStomach(), scopeUrdf(), log);
  const ContactCase pressed = states.prepare("pressed");
  EXPECT_LT(pressed.start.tool_force.norm(), 0.1);  // [N]
  const ContactTrace push = runContact(pressed, {60, 4, 0.2});
  EXPECT_GT(push.contacts, 0);
  EXPECT_GT(push.force.back().norm(), 0.5);  // [N]
  const ContactCase cinch = states.prepare("cinch1");
  ASSERT_EQ(cinch.start.procedure.sutures.size(), 1u);
  EXPECT_EQ(cinch.start.procedure.sutures.back().stage, Suture::Stage::Tagged);
  const ContactTrace drawn = runContact(cinch, {60, 4, 0.2});
  EXPECT_GT(drawn.force.back().x(), 1);  // [N]
  EXPECT_THROW(states.prepare("juggled"), Error);
  ContactCase brief = pressed;
  brief.duration = 0.5;
  const double begin = steadyTime();
  runContact(brief, {60, 4, 0.2, false, 1, true});
  EXPECT_GT(steadyTime() - begin, 0.48);  // [s], of real time
}

TEST(Contact, ChecksSeeAWallThatCrossesAndAToolThatPassesThrough) {
  const auto model = buildModel(coarseStomach(), scopeUrdf());
  State state = initialState(*model, 1);
  ContactCheck check(*model);
  EXPECT_TRUE(check.wall(state).empty());
  EXPECT_EQ(check.tool(state).pierced, 0);
  EXPECT_EQ(check.tool(state).depth, 0);
  State through = state;
  through.joints[Insertion] = model->tool->limits()[Insertion].upper;  // straight through the far wall
  const vibe::test::ToolCrossing crossing = check.tool(through);
  EXPECT_GT(crossing.pierced, 0);
  EXPECT_GT(crossing.depth, 5e-3);
  for (auto* axis : {&state.x, &state.y, &state.z}) {  // one vertex far out through the other side
    double middle = 0;
    for (double place : *axis) middle += place / model->particle_count;
    (*axis)[300] = middle - 3 * ((*axis)[300] - middle);
  }
  EXPECT_GT(check.wall(state).size(), 0u);
}

}  // namespace
}  // namespace vibe::benchmarks::contact_test
