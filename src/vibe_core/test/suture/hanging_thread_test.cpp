#include "suture/hanging_thread.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "suture/thread_reference.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

using Eigen::Vector3d;
constexpr double kFrame = 1.0 / 60, kGravity = 9.81, kTwoPi = 6.28318530717958647692;

/// The thread of the reference: 0.02 N/m, 0.3 m; y up. So stiff that its weight stretches it by 1e-9.
HangingThreadModel referenceThread(int links) {
  HangingThreadModel model;
  model.links = links;
  model.length = 0.3;
  model.mass_per_length = 0.02 / kGravity;
  model.axial_stiffness = 1e6;
  model.tip_mass = 0;
  model.drag = 0;
  model.largest_substep = 1.0 / 960;
  model.gravity = Vector3d(0, -kGravity, 0);
  return model;
}

ThreadEnds held(const Vector3d& first, const Vector3d& last) {
  return {true, true, first, last};
}

ThreadEnds hanging(const Vector3d& first) {
  return {true, false, first, Vector3d::Zero()};
}

/// Comes to rest from a thread that hung elsewhere.
HangingThread rest(HangingThreadModel model, const ThreadEnds& ends) {
  model.drag = 10;
  ThreadEnds other = ends;
  other.last += Vector3d(-0.03, 0.06, 0.05);
  HangingThread state = threadAtRest(model, other);
  HangingThreadScratch scratch;
  for (int i = 0; i < 300; ++i) stepThread(model, ends, kFrame, state, scratch);
  EXPECT_LT(state.velocity.cwiseAbs().maxCoeff(), 1e-6);
  return state;
}

void expectRest(const std::string& name, const Vector3d& last) {
  const auto value = [&](const std::string& quantity) { return test::referenceValue(name, quantity); };
  for (const int links : {30, 60}) {
    const HangingThreadModel model = referenceThread(links);
    const HangingThread state = rest(model, held(Vector3d::Zero(), last));
    const double lowest = state.position.row(1).minCoeff();
    const double level = pullOnFirst(model, state).x();
    // Its own reference, a chain of that many links, and within 1 % the thread without links.
    const std::string chain = "chain" + std::to_string(links);
    EXPECT_NEAR(lowest / value(chain + "_lowest_node_y_m"), 1, 1e-6) << name << links;
    EXPECT_NEAR(level / value(chain + "_H_N"), 1, 1e-6) << name << links;
    // Negative control: it is not the chain of the other number of links.
    EXPECT_GT(std::abs(level / value(links == 30 ? "chain60_H_N" : "chain30_H_N") - 1), 1e-5);
    EXPECT_NEAR(lowest / value("lowest_y_m"), 1, 0.01);
    EXPECT_NEAR(level / value("horizontal_tension_N"), 1, 0.01);
    EXPECT_NEAR(pullOnFirst(model, state).norm() / value("tension_A_N"), 1, 0.01);
    EXPECT_NEAR(pullOnLast(model, state).norm() / value("tension_B_N"), 1, 0.01);
    EXPECT_NEAR(chainLength(state) / 0.3, 1, 1e-6);
  }
}

TEST(HangingThread, RestsAsTheReferenceBetweenLevelEnds) {
  expectRest("9a_level", {0.2, 0, 0});
}

TEST(HangingThread, RestsAsTheReferenceBetweenUnevenEnds) {
  expectRest("9b_uneven", {0.2, -0.05, 0});
}

TEST(HangingThread, CarriesItsTipAndItself) {
  HangingThreadModel model = referenceThread(60);
  model.tip_mass = 0.01;
  const HangingThread state = rest(model, hanging(Vector3d::Zero()));
  const auto value = [](const char* quantity) { return test::referenceValue("9c_vertical", quantity); };
  EXPECT_NEAR(pullOnFirst(model, state).norm() / value("tension_top_N"), 1, 1e-6);
  EXPECT_NEAR(0.5 * (state.tension[29] + state.tension[30]) / value("tension_mid_N"), 1, 1e-6);
  EXPECT_NEAR((state.tension[59] - 0.5 * 0.02 * model.linkLength()) / value("tension_bottom_N"), 1, 1e-6);
}

/// A small swing in one mode of the thread that hangs from one end: J0(2 w sqrt(z / g)), z above the free end.
struct Swing {
  HangingThreadModel model = referenceThread(60);
  Eigen::VectorXd mode;
  HangingThread state;
  HangingThreadScratch scratch;

  explicit Swing(double frequency) : mode(61) {
    state = threadAtRest(model, hanging(Vector3d::Zero()));
    for (int j = 0; j <= 60; ++j) {
      const double z = model.length - j * model.linkLength();
      mode[j] = std::cyl_bessel_j(0, 2 * kTwoPi * frequency * std::sqrt(z / kGravity));
      state.position(0, j) = j == 0 ? 0 : 1e-4 * mode[j];
    }
  }
  double along() const {
    double sum = 0;
    for (int j = 1; j <= 60; ++j) sum += model.nodeMass(j) * mode[j] * state.position(0, j);
    return sum;
  }
  /// Times at which the mode passes through the middle, and how far it went between them.
  void run(double duration, std::vector<double>& crossings, std::vector<double>& peaks) {
    double before = along(), peak = 0;
    for (int i = 1; i * (1.0 / 240) < duration; ++i) {
      stepThread(model, hanging(Vector3d::Zero()), 1.0 / 240, state, scratch);
      const double now = along();
      peak = std::max(peak, std::abs(now));
      if (before * now < 0) {
        crossings.push_back((i - now / (now - before)) / 240);
        peaks.push_back(peak);
        peak = 0;
      }
      before = now;
    }
  }
};

TEST(HangingThread, SwingsAtTheReferenceFrequencies) {
  for (const char* name : {"f1_Hz", "f2_Hz", "f3_Hz"}) {
    const double frequency = test::referenceValue("9d_hanging_chain_no_tip", name);
    Swing swing(frequency);
    std::vector<double> crossings, peaks;
    swing.run(5 / frequency, crossings, peaks);
    ASSERT_GE(crossings.size(), 9u);
    const double measured = 0.5 * static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
    EXPECT_NEAR(measured / frequency, 1, 0.005) << name;
    RecordProperty(name, std::to_string(measured));
  }
}

TEST(HangingThread, SwingsFadeByDragAndByTheStepAsStated) {
  const double frequency = test::referenceValue("9d_hanging_chain_no_tip", "f1_Hz"), w = kTwoPi * frequency;
  for (const double drag : {0.0, 0.9}) {
    Swing swing(frequency);
    swing.model.drag = drag;
    std::vector<double> crossings, peaks;
    swing.run(5 / frequency, crossings, peaks);
    const double lasted = crossings.back() - crossings[1];
    const double rate = -std::log(peaks.back() / peaks[1]) / lasted;
    EXPECT_NEAR(rate / (0.5 * drag + 0.5 * w * w * swing.model.largest_substep), 1, 0.05) << drag;
  }
}

TEST(HangingThread, FallsFreely) {
  const HangingThreadModel model = referenceThread(20);
  const ThreadEnds free{false, false, Vector3d(0, 1, 0), Vector3d::Zero()};
  HangingThread state = threadAtRest(model, free);
  const HangingThread start = state;
  HangingThreadScratch scratch;
  for (int i = 0; i < 12; ++i) stepThread(model, free, kFrame, state, scratch);
  const double t = 0.2, h = kFrame / 16;  // backward Euler falls g t (t + h) / 2
  const Eigen::Matrix3Xd fall = start.position - state.position;
  EXPECT_NEAR(fall.row(1).minCoeff(), 0.5 * kGravity * t * (t + h), 1e-9);
  EXPECT_NEAR(fall.row(1).maxCoeff(), 0.5 * kGravity * t * (t + h), 1e-9);
}

double energy(const HangingThreadModel& model, const HangingThread& state) {
  double sum = 0;
  for (int j = 0; j <= model.links; ++j)
    sum += model.nodeMass(j) * (0.5 * state.velocity.col(j).squaredNorm() - model.gravity.dot(state.position.col(j)));
  return sum;
}

TEST(HangingThread, LosesEnergyAsItFallsFromLevel) {
  const HangingThreadModel model = referenceThread(40);
  HangingThread state = threadAtRest(model, held({0, 0, 0}, {0.29999, 0, 0}));
  HangingThreadScratch scratch;
  double before = energy(model, state);
  for (int i = 0; i < 120; ++i) {
    stepThread(model, hanging({0, 0, 0}), kFrame, state, scratch);
    const double now = energy(model, state);
    EXPECT_LT(now, before + 1e-9) << i;
    before = now;
    EXPECT_NEAR(chainLength(state) / 0.3, 1, 1e-3);
  }
}

HangingThreadModel suture(int links) {
  return hangingThread(polypropylene20(), 0.3, links, {0, 0, -kGravity});
}

TEST(HangingThread, KeepsItsLengthWhenAnEndJumpsByThirtyCentimetres) {
  for (const int links : {1, 2, 10, 60, 1000}) {
    const HangingThreadModel model = suture(links);
    HangingThread state = threadAtRest(model, held({0, 0, 0}, {0.2, 0, 0}));
    HangingThreadScratch scratch;
    for (int i = 0; i < (links > 100 ? 12 : 60); ++i) {
      const Vector3d last = i % 4 < 2 ? Vector3d(0.2, 0.05, 0.01) : Vector3d(-0.1, 0.05, 0.01);
      stepThread(model, held({0, 0, 0}, last), kFrame, state, scratch);
      ASSERT_TRUE(state.position.allFinite() && state.velocity.allFinite() && state.tension.allFinite());
      const double tolerance = links > 1 ? 1e-3 : 1;  // one link cannot be both as long as it is and held elsewhere
      EXPECT_NEAR(chainLength(state) / 0.3, 1, tolerance) << links << ' ' << i;
      EXPECT_EQ(Vector3d(state.position.col(links)), last);
    }
  }
}

TEST(HangingThread, IsStretchedStraightByEndsThatAreTooFarApart) {
  const HangingThreadModel model = suture(60);
  HangingThread state = threadAtRest(model, held({0, 0, 0}, {0.2, 0, 0}));
  HangingThreadScratch scratch;
  for (int i = 0; i < 60; ++i) stepThread(model, held({0, 0, 0}, {0.33, 0, 0}), kFrame, state, scratch);
  EXPECT_NEAR(state.tension.minCoeff() / (0.1 * model.axial_stiffness), 1, 1e-3);
  EXPECT_NEAR(state.tension.maxCoeff() / (0.1 * model.axial_stiffness), 1, 1e-3);
  EXPECT_LT(state.position.bottomRows<2>().cwiseAbs().maxCoeff(), 1e-6);
  for (int i = 0; i < 120; ++i) stepThread(model, held({0, 0, 0}, {0.2, 0, 0}), kFrame, state, scratch);
  EXPECT_NEAR(chainLength(state) / 0.3, 1, 1e-4);
}

TEST(HangingThread, TakesStepsOfEveryLength) {
  for (const double dt : {1e-4, 1e-3, kFrame, 0.1})
    for (const double substep : {1.0 / 960, 1.0}) {
      HangingThreadModel model = suture(60);
      model.drag = 10;
      model.largest_substep = substep;
      HangingThread state = threadAtRest(model, held({0, 0, 0}, {0.2, 0, 0}));
      const HangingThread start = state;
      HangingThreadScratch scratch;
      const int steps = dt < 1e-3 ? 2000 : 200;
      for (int i = 0; i < steps; ++i) {
        const Vector3d last(0.15 + 0.05 * std::cos(kTwoPi * i / steps), 0, 0);
        stepThread(model, held({0, 0, 0}, last), dt, state, scratch);
        ASSERT_NEAR(chainLength(state) / 0.3, 1, 1e-3) << dt;
      }
      for (int i = 0; i < 40; ++i) stepThread(model, held({0, 0, 0}, {0.2, 0, 0}), 0.1, state, scratch);
      EXPECT_LT((state.position - start.position).cwiseAbs().maxCoeff(), 2e-4) << dt;
    }
}

TEST(HangingThread, SeesOnlyWhereItsEndsAreRelativeToGravity) {
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, -2, 0.4).normalized());
  const Vector3d move(1, 2, -3), a(0, 0, 0), b(0.2, 0.05, 0), way(-0.1, -0.1, 0.1);
  const HangingThreadModel model = suture(30);
  HangingThreadModel turned_model = model;
  turned_model.gravity = turn * model.gravity;
  HangingThread one = threadAtRest(model, held(a, b));
  HangingThread turned = threadAtRest(turned_model, held(turn * a + move, turn * b + move));
  HangingThread reversed = threadAtRest(model, held(b, a));
  HangingThreadScratch scratch;
  for (int i = 1; i <= 20; ++i) {
    const Vector3d to = b + way * (i / 20.0);
    stepThread(model, held(a, to), kFrame, one, scratch);
    stepThread(turned_model, held(turn * a + move, turn * to + move), kFrame, turned, scratch);
    stepThread(model, held(to, a), kFrame, reversed, scratch);
  }
  const Eigen::Matrix3Xd expected = (turn.toRotationMatrix() * one.position).colwise() + move;
  EXPECT_LT((turned.position - expected).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((reversed.position.rowwise().reverse() - one.position).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(HangingThread, IsTheSameEveryTimeAndNeedsNoMemory) {
  const HangingThreadModel model = suture(60);
  HangingThread one = threadAtRest(model, held({0, 0, 0}, {0.2, 0, 0})), other = one;
  HangingThreadScratch scratch, used;
  HangingThread elsewhere = threadAtRest(model, hanging({1, 1, 1}));
  stepThread(model, hanging({2, 1, 1}), kFrame, elsewhere, used);
  stepThread(model, held({0, 0, 0}, {0.1, 0, 0}), kFrame, one, scratch);
  [[maybe_unused]] const long before = test::allocations;
  stepThread(model, held({0, 0, 0}, {0.1, 0, 0}), kFrame, other, used);
#if VIBE_COUNTS_ALLOCATIONS
  EXPECT_EQ(test::allocations, before);
#endif
  EXPECT_EQ(one.position, other.position);
  EXPECT_EQ(one.velocity, other.velocity);
  EXPECT_EQ(one.tension, other.tension);
}

TEST(HangingThread, RefusesWhatIsNoThreadAndLeavesItsStateAlone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const HangingThreadModel model = suture(10);
  const ThreadEnds ends = held({0, 0, 0}, {0.2, 0, 0});
  const HangingThread state = threadAtRest(model, ends);
  HangingThreadScratch scratch;
  const auto expect = [&](const HangingThreadModel& m, const ThreadEnds& e, double dt, HangingThread s) {
    const HangingThread before = s;
    EXPECT_THROW(stepThread(m, e, dt, s, scratch), Error);
    EXPECT_EQ(s.position, before.position);
  };
  expect(model, held({nan, 0, 0}, {0.2, 0, 0}), kFrame, state);
  expect(model, held({0, 0, 0}, {0.2, std::numeric_limits<double>::infinity(), 0}), kFrame, state);
  expect(model, ends, nan, state);
  expect(model, ends, 0, state);
  expect(model, ends, 1e9, state);
  expect(suture(11), ends, kFrame, state);
  HangingThread broken = state;
  broken.velocity(1, 3) = nan;
  expect(model, ends, kFrame, broken);
  HangingThreadModel bad = model;
  bad.axial_stiffness = 0;
  expect(bad, ends, kFrame, state);
  bad = model;
  bad.links = 0;
  EXPECT_THROW(threadAtRest(bad, ends), Error);
}

}  // namespace
}  // namespace vibe
