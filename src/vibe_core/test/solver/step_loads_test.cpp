// What acts on a body during implicit steps: conditions, contacts, gas; and that a step depends on nothing else.
#include <gtest/gtest.h>

#include "solver/balloon.hpp"

namespace vibe::step_loads_test {
namespace {

using namespace test;

StepSettings steps(double step, int iterations = 20) {
  StepSettings settings;
  settings.step = step;
  settings.iterations = iterations;
  settings.tolerance = 1e-8;
  return settings;
}

LinearConstraint meanOf(const std::vector<int>& nodes, const Eigen::Vector3d& along, const ElasticBody& body,
                        double moved) {
  LinearConstraint constraint;
  constraint.node = nodes;
  constraint.coefficient.assign(nodes.size(), along / static_cast<double>(nodes.size()));
  for (int node : nodes) constraint.target += along.dot(body.rest[node]) / static_cast<double>(nodes.size());
  constraint.target += moved;
  return constraint;
}

double valueOf(const LinearConstraint& constraint, const Body& run) {
  double value = 0;
  for (std::size_t k = 0; k < constraint.node.size(); ++k)
    value += constraint.coefficient[k].dot(run.position(constraint.node[k]));
  return value;
}

TEST(Conditions, AreMetByEveryStep) {
  const ElasticBody body = cantilever();
  Body run(body, steps(1.0 / 60, 3));
  const int tip = run.nodes() - 1;
  run.loads.constraints = {meanOf({tip, tip - 4, tip - 9}, {0, 0, 1}, body, 0), meanOf({tip}, {0, 1, 0}, body, 0)};
  const double z = run.loads.constraints[0].target;
  for (int i = 1; i <= 60; ++i) {
    run.loads.constraints[0].target = z + 0.015 * std::min(1.0, i / 30.0);
    run.step();
    for (const LinearConstraint& constraint : run.loads.constraints)
      ASSERT_NEAR(valueOf(constraint, run), constraint.target, 1e-6) << "step " << i;
  }
}

TEST(Conditions, ForceIsTheReactionOfTheTissue) {
  const ElasticBody body = cantilever();
  Body run(body);
  const int tip = run.nodes() - 1;
  run.loads.constraints = {meanOf({tip, tip - 4, tip - 9}, {0, 0.6, 0.8}, body, 0.01),
                           meanOf({tip}, {1, 0, 0}, body, 0)};
  ASSERT_TRUE(run.settle().converged);
  Eigen::VectorXd residual = run.elastic().gradient;
  const double whole = residual.norm();
  for (const LinearConstraint& constraint : run.loads.constraints)
    for (std::size_t k = 0; k < constraint.node.size(); ++k)
      residual.segment<3>(3 * constraint.node[k]) -= constraint.force * constraint.coefficient[k];
  for (int i = 0; i < run.nodes(); ++i)
    if (body.fixed[i] != 0) residual.segment<3>(3 * i).setZero();
  EXPECT_GT(run.loads.constraints[0].force, 0.01);
  EXPECT_LT(residual.norm(), 1e-3 * whole);
}

TEST(Conditions, ComplianceGivesWay) {
  const ElasticBody body = cantilever();
  Body hard(body), soft(body);
  const int tip = hard.nodes() - 1;
  hard.loads.constraints = {meanOf({tip}, {0, 0, 1}, body, 0.01)};
  soft.loads.constraints = hard.loads.constraints;
  soft.loads.constraints[0].compliance = 0.2;
  ASSERT_TRUE(hard.settle().converged);
  ASSERT_TRUE(soft.settle().converged);
  const LinearConstraint& constraint = soft.loads.constraints[0];
  EXPECT_NEAR(valueOf(constraint, soft), constraint.target - 0.2 * constraint.force, 1e-6);
  EXPECT_GT(constraint.force, 0.01);
  EXPECT_LT(constraint.force, 0.95 * hard.loads.constraints[0].force);
}

/// A block on a plane through its underside, in a gravity that leans by an angle.
struct Slope {
  Slope(double angle, double friction) : run(makeBody(angle), steps(1.0 / 120)), friction_(friction) {}
  static ElasticBody makeBody(double angle) {
    ElasticBody body = block({3, 3, 2}, neoHookean(0.3));
    body.gravity = 9.81 * Eigen::Vector3d(std::sin(angle), 0, -std::cos(angle));
    body.stiffness_damping = 1e-2;
    return body;
  }
  void step() {
    run.loads.contacts.clear();
    for (int i = 0; i < run.nodes(); ++i)
      if (run.stepper.body().rest[i].z() < 1e-9)
        run.loads.contacts.push_back({SurfacePoint::ofNode(i), {0, 0, 1}, 0, 0, friction_, 0, run.position(i)});
    run.step();
    sum.setZero();
    for (const ContactConstraint& contact : run.loads.contacts) {
      sum += contact.force;
      pulling = std::min(pulling, contact.force.z());
      outside = std::max(outside, contact.force.head<2>().norm() - friction_ * contact.force.z());
      sunk = std::min(sunk, run.position(contact.point.node[0]).z());
    }
  }
  double meanSpeed() const { return run.momentum().x() / run.mass(); }

  Body run;
  double friction_;
  double pulling = 0, outside = 0, sunk = 0;      // the worst of all steps
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // of the last step
};

TEST(Contacts, CarryTheWeight) {
  Slope world(0, 0.3);
  for (int i = 0; i < 240; ++i) world.step();
  const double weight = 9.81 * world.run.mass();
  EXPECT_NEAR(world.sum.z(), weight, 2e-3 * weight);
  EXPECT_LT(world.sum.head<2>().norm(), 2e-3 * weight);
  EXPECT_GE(world.pulling, 0);
  EXPECT_LT(world.outside, 1e-4 * weight);
  EXPECT_GT(world.sunk, -1e-6);
}

TEST(Contacts, StickBelowTheAngleOfFriction) {
  const double angle = 0.2;
  Slope world(angle, 0.3);  // tan 0.2 = 0.203
  for (int i = 0; i < 240; ++i) world.step();
  const double before = world.run.position(0).x();
  for (int i = 0; i < 120; ++i) world.step();
  EXPECT_NEAR(world.run.position(0).x(), before, 2e-5);
  EXPECT_NEAR(world.sum.x(), -9.81 * std::sin(angle) * world.run.mass(), 0.01 * 9.81 * world.run.mass());
  EXPECT_LT(world.outside, 1e-4 * 9.81 * world.run.mass());
}

TEST(Contacts, SlideAboveIt) {
  const double angle = 0.5, friction = 0.3;  // tan 0.5 = 0.546
  Slope world(angle, friction);
  for (int i = 0; i < 60; ++i) world.step();
  const double before = world.meanSpeed();
  for (int i = 0; i < 60; ++i) world.step();
  const double gained = (world.meanSpeed() - before) / 0.5;
  EXPECT_NEAR(gained, 9.81 * (std::sin(angle) - friction * std::cos(angle)), 0.03 * 9.81);
  EXPECT_GE(world.pulling, 0);
}

// A plate lies on more contacts than a step has rows for and is pressed down where there was a gap: these contacts are
// the farthest at the start of the step, and the only ones that push.
TEST(Contacts, ThoseThatPushTakeTheRowsWhereThereAreTooMany) {
  ElasticBody body = block({16, 10, 1}, neoHookean(0.3));
  body.mass_damping = 10;
  Body run(body, steps(1.0 / 60, 6));
  const double end = 15.5 * kSide, gap = 5e-4, pressed = 2e-3;
  std::vector<int> over_gap;
  for (int n = 0; n < run.nodes(); ++n) {
    const bool below = body.rest[n].z()<1e-9, at_end = body.rest[n].x()> end;
    if (at_end && !below) run.loads.constraints.push_back(meanOf({n}, {0, 0, 1}, body, -pressed));
    if (!below) continue;
    if (at_end) over_gap.push_back(n);
    run.loads.contacts.push_back({SurfacePoint::ofNode(n), {0, 0, 1}, at_end ? -gap : 0, 0, 0.3, 0, run.position(n)});
  }
  ASSERT_GT(run.loads.contacts.size(), 150);
  ASSERT_TRUE(run.step().finite);
  for (const ContactConstraint& contact : run.loads.contacts)
    EXPECT_GT(run.position(contact.point.node[0]).z(), contact.offset - 1.5e-4) << contact.point.node[0];
  for (const int n : over_gap) EXPECT_NEAR(run.position(n).z(), -gap, 1e-5) << n;
}

TEST(Contacts, PinchFromBothSidesAndLetGo) {
  ElasticBody body = block({3, 3, 2}, neoHookean(0.3));
  body.mass_damping = 10;
  Body run(body, steps(1.0 / 60));
  const double top = 2 * kSide;
  for (int i = 0; i < 60; ++i) {
    const double half_gap = 0.5 * top * (1 - 0.4 * std::min(1.0, i / 30.0));
    run.loads.contacts.clear();
    for (int n = 0; n < run.nodes(); ++n) {
      const double z = body.rest[n].z();
      if (z < 1e-9)
        run.loads.contacts.push_back(
            {SurfacePoint::ofNode(n), {0, 0, 1}, 0.5 * top - half_gap, 0, 0.3, 0, run.position(n)});
      if (z > top - 1e-9)
        run.loads.contacts.push_back(
            {SurfacePoint::ofNode(n), {0, 0, -1}, -0.5 * top - half_gap, 0, 0.3, 0, run.position(n)});
    }
    ASSERT_TRUE(run.step().finite);
    double below = 0, above = 0;
    for (const ContactConstraint& contact : run.loads.contacts) {
      ASSERT_GE(contact.force.dot(contact.normal), 0);
      ASSERT_GT(contact.normal.dot(run.position(contact.point.node[0])) - contact.offset, -1e-5);
      (contact.normal.z() > 0 ? below : above) += contact.force.z();
    }
    if (i < 50) continue;
    ASSERT_NEAR(below, -above, 0.02 * below);
    ASSERT_GT(below, 0.2 * kE * 9 * kSide * kSide);
  }
  run.loads.contacts.clear();
  for (int i = 0; i < 120; ++i) run.step();
  EXPECT_LT(run.elastic().energy, 1e-9) << "nothing is left of it";
}

/// Pressure in a thin sphere whose radius has grown by a factor, dU/dV of U = 4 pi R^2 t W: the closed form for the
/// neo-Hookean law W = mu/2 (I - 3) - mu ln J + lambda/2 ln^2 J, stretched equally in the plane and free in thickness.
double balloonPressure(double stretch) {
  const double mu = kE / (2 * (1 + kNu)), lambda = kE * kNu / ((1 + kNu) * (1 - 2 * kNu));
  double low = 0.1, high = 2;  // stretch s of the thickness: mu (s^2 - 1) + lambda ln(stretch^2 s) = 0
  for (int i = 0; i < 100; ++i) {
    const double s = 0.5 * (low + high);
    (mu * (s * s - 1) + lambda * std::log(stretch * stretch * s) > 0 ? high : low) = s;
  }
  const double log_volume = std::log(stretch * stretch * low);
  const double slope = 2 * (mu * (stretch - 1 / stretch) + lambda * log_volume / stretch);  // dW / dstretch
  return BallOptions().wall * slope / (Ball::kRadius * stretch * stretch);
}

TEST(Gas, PressureAmountAndVolumeAgree) {
  for (double pressure : {5.0, 100.0}) {
    Ball by_pressure, by_volume, by_amount;
    const double rest = by_pressure.volume();
    by_pressure.gas().control = GasLoad::Control::Pressure;
    by_pressure.gas().pressure = pressure;
    by_pressure.gas().volume = rest;
    ASSERT_TRUE(by_pressure.run->settle(1e-6).finite);  // it floats: a drift is left
    const double volume = by_pressure.volume();
    EXPECT_NEAR(by_pressure.gas().volume, volume, 1e-6 * volume);

    by_volume.gas().control = GasLoad::Control::Volume;
    by_volume.gas().target_volume = volume;
    by_volume.gas().volume = rest;
    ASSERT_TRUE(by_volume.run->settle(1e-6).finite);
    EXPECT_NEAR(by_volume.volume(), volume, 1e-5 * volume);
    EXPECT_NEAR(by_volume.gas().pressure, pressure, 2e-3 * pressure);

    by_amount.gas().control = GasLoad::Control::Amount;
    by_amount.gas().amount = (by_amount.gas().ambient + pressure) * volume;
    by_amount.gas().volume = rest;
    ASSERT_TRUE(by_amount.run->settle(1e-6).finite);
    EXPECT_NEAR(by_amount.volume(), volume, 1e-5 * volume);
    EXPECT_NEAR(by_amount.gas().pressure, pressure, 0.02 * pressure) << "a difference of two atmospheres";

    const double paper = balloonPressure(std::cbrt(volume / rest));
    EXPECT_NEAR(paper, pressure, 0.015 * pressure);  // the flat triangles of the ball cost 1.2 %
  }
}

TEST(Gas, SwitchedOffLeavesNothingBehind) {
  Ball fresh(steps(1.0 / 60, 1)), used(steps(1.0 / 60, 1));
  used.gas().control = GasLoad::Control::Amount;
  used.gas().amount = 101325 * used.volume();
  used.run->loads.constraints = {meanOf({3}, {1, 0, 0}, used.run->stepper.body(), 0)};
  used.run->step();
  used.run->motion = fresh.run->motion;
  used.run->memory = fresh.run->memory;
  used.gas() = GasLoad();
  for (Ball* ball : {&fresh, &used}) {
    ball->run->loads.constraints = {meanOf({3}, {1, 0, 0}, ball->run->stepper.body(), 1e-3)};
    ball->run->step();
  }
  EXPECT_TRUE(sameBits(fresh.run->motion, used.run->motion));
}

// Everything at once, with contacts and conditions that come and go.
void load(Body& run, int step) {
  const ElasticBody& body = run.stepper.body();
  const int tip = run.nodes() - 1;
  run.loads.constraints.clear();
  run.loads.contacts.clear();
  if (step % 40 > 5)
    run.loads.constraints.push_back(meanOf({tip, tip - 3}, {0, 0, 1}, body, 0.015 * std::sin(0.2 * step)));
  for (int k = 0; k < 4; ++k) {
    const int node = 20 + (11 * k + 17 * (step / 7)) % (tip - 30);
    if ((step / 5 + k) % 3 != 0)
      run.loads.contacts.push_back(
          {SurfacePoint::ofNode(node), {0, 0, 1}, body.rest[node].z() - 1e-3, 0, 0.3, 0, run.position(node)});
  }
}

ElasticBody replayBody() {
  ElasticBody body = cantilever();
  body.gravity = {0, 0, -9.81};
  body.mass_damping = 2;
  return body;
}

StepSettings replaySettings() {
  StepSettings settings;
  settings.refactor_interval = 3 * settings.step;
  settings.refactor_distance = 1e-5;
  return settings;
}

constexpr int kReplaySteps = 90;

TEST(Replay, TwoRunsHaveTheSameBits) {
  Body a(replayBody(), replaySettings()), b(replayBody(), replaySettings());
  for (int i = 0; i < kReplaySteps; ++i)
    for (Body* run : {&a, &b}) load(*run, i), run->step();
  EXPECT_TRUE(sameBits(a.motion, b.motion));
  EXPECT_FALSE(a.memory.linearization_point.empty()) << "the factor must have been made anew for this to mean anything";
}

TEST(Replay, ACopyOfMotionAndMemoryHasTheSameFuture) {
  for (int at : {1, 2, 3, 13, 31}) {
    Body run(replayBody(), replaySettings()), copy(replayBody(), replaySettings());
    for (int i = 0; i < at; ++i) load(run, i), run.step();
    copy.motion = run.motion;
    copy.memory = run.memory;
    for (int i = at; i < kReplaySteps; ++i) {
      for (Body* r : {&run, &copy}) load(*r, i), r->step();
      ASSERT_TRUE(sameBits(run.motion, copy.motion)) << "copied at " << at << ", differs after " << i;
    }
  }
}

TEST(Replay, AFreshScratchAtEveryStepHasTheSameBits) {
  Body kept(replayBody(), replaySettings()), fresh(replayBody(), replaySettings());
  for (int i = 0; i < kReplaySteps; ++i) {
    fresh.scratch = fresh.stepper.makeWorkspace();
    for (Body* run : {&kept, &fresh}) load(*run, i), run->step();
    ASSERT_TRUE(sameBits(kept.motion, fresh.motion)) << "step " << i;
  }
}

TEST(Replay, WithoutTheMemoryTheBitsDiffer) {
  Body run(replayBody(), replaySettings()), copy(replayBody(), replaySettings());
  for (int i = 0; i < 31; ++i) load(run, i), run.step();
  copy.motion = run.motion;
  for (int i = 31; i < 34; ++i)
    for (Body* r : {&run, &copy}) load(*r, i), r->step();
  EXPECT_FALSE(sameBits(run.motion, copy.motion));
}

}  // namespace
}  // namespace vibe::step_loads_test
