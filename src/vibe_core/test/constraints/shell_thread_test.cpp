// Threads in a wall of shell, solved with the step.
#include <gtest/gtest.h>

#include "solver/pulled_sheet.hpp"
#include "suture/capstan.hpp"

namespace vibe::shell_thread_test {
namespace {

using test::PulledSheet;
using test::sheetParticle;
using test::sheetScene;

constexpr double kDrawSpeed = 15e-3;  // [m/s]
constexpr int kMiddle = test::kColumns / 2, kRow = test::kRows / 2;

// Three bites in a bow: 16 mm to either side of the middle, and one off their line.
PulledSheet bow(double friction) {
  Scene scene = sheetScene("shell", "thread");
  scene.suture->thread_friction = friction;
  PulledSheet sheet(scene, 4);
  Suture& set = sheet.set();
  Bite between = set.bites.front();
  between.particle = {sheetParticle(kMiddle + 1, kRow + 3)};
  set.bites.insert(set.bites.begin() + 1, between);
  set.tension = {0, 0};
  set.length = {(sheet.bite(1) - sheet.bite(0)).norm(), (sheet.bite(2) - sheet.bite(1)).norm()};
  return sheet;
}

double pull(PulledSheet& sheet) {
  const double whole = sheet.set().length[0] + sheet.set().length[1];
  sheet.draw(8e-3);
  sheet.run(2);
  EXPECT_NEAR(sheet.set().length[0] + sheet.set().length[1], whole - 8e-3, 1e-9) << "what slides stays thread";
  return sheet.set().tension[0] / sheet.set().tension[1];
}

void expectOnTheThread(const PulledSheet& sheet) {
  const Suture& set = sheet.set();
  for (std::size_t k = 0; k < set.length.size(); ++k)
    EXPECT_NEAR((sheet.bite(static_cast<int>(k) + 1) - sheet.bite(static_cast<int>(k))).norm(),
                set.length[k] * (1 + set.tension[k] / sheet.model->scene.suture->thread_stiffness), 2e-6);
}

TEST(ShellThread, WithoutFrictionOneTensionIsEverywhere) {
  PulledSheet sheet = bow(0);
  EXPECT_NEAR(pull(sheet), 1, 1e-3);
  EXPECT_GT(sheet.set().tension[0], 0.1);
  expectOnTheThread(sheet);
}

TEST(ShellThread, DrawnFromOneEndTheTensionFallsByTheCapstanFactor) {
  PulledSheet sheet = bow(0.15);
  const double ratio = pull(sheet);
  const double max = capstanFactor(0.15, turningAngle(sheet.bite(0), sheet.bite(1), sheet.bite(2)));
  EXPECT_GT(max, 1.1);
  EXPECT_NEAR(ratio, max, 0.02 * max);
  expectOnTheThread(sheet);
}

// Five bites in a zigzag, drawn at a constant speed with steps of any length.
PulledSheet zigzag(double rate) {
  Scene scene = sheetScene("shell", "thread");
  scene.suture->thread_friction = 0.15;
  scene.step_period = 1 / rate;
  PulledSheet sheet(scene, 4);
  Suture& set = sheet.set();
  for (const int k : {1, 2, 3}) {
    Bite between = set.bites.front();
    between.particle = {sheetParticle(kMiddle - 4 + 2 * k, k % 2 == 0 ? kRow - 2 : kRow + 2)};
    set.bites.insert(set.bites.end() - 1, between);
  }
  set.length.clear();
  for (int k = 0; k < 4; ++k) set.length.push_back((sheet.bite(k + 1) - sheet.bite(k)).norm());
  set.tension.assign(4, 0.0);
  return sheet;
}

// Ratio of the tensions at a bite over its limit, farthest from 1 in thirty steps in which all thread slides.
double farthestFromTheLimit(PulledSheet& sheet) {
  double farthest = 0;
  for (int step = 0; step < 30; ++step) {
    const Suture before = sheet.set();
    double limit[3] = {};
    for (int k = 0; k < 3; ++k)
      limit[k] = capstanFactor(0.15, turningAngle(sheet.bite(k), sheet.bite(k + 1), sheet.bite(k + 2)));
    sheet.draw(kDrawSpeed * sheet.model->scene.step_period, kDrawSpeed);
    const Suture& set = sheet.set();
    for (std::size_t k = 0; k < 3; ++k)
      farthest = std::max(farthest, std::abs(set.tension[k] / set.tension[k + 1] / limit[k] - 1));
    EXPECT_LT(set.length.back(), before.length.back()) << "control: it slides through every bite";
  }
  return farthest;
}

// With half of the foreseen slide per step, the ratio was 22, 6 and 2 % off at 60, 240 and 960 Hz, and the first
// segment kept 0.12 and 0.02 mm less at 60 and 240 Hz than at 960 Hz.
TEST(ShellThread, DrawnThroughManyBitesItSlidesToTheLimitInStepsOfAnyLength) {
  std::vector<double> converged;
  for (const double rate : {960.0, 240.0, 60.0}) {
    PulledSheet sheet = zigzag(rate);
    sheet.draw(4e-3, kDrawSpeed);
    const std::vector<double> length = sheet.set().length;
    if (converged.empty()) converged = length;
    for (std::size_t k = 0; k < length.size(); ++k) EXPECT_NEAR(length[k], converged[k], 2e-6) << rate << " Hz, " << k;
    EXPECT_LT(farthestFromTheLimit(sheet), 1e-9) << rate << " Hz";
    expectOnTheThread(sheet);
  }
}

TEST(ShellThread, AKnotLetsNothingSlide) {
  PulledSheet sheet = bow(0.15);
  sheet.draw(4e-3);
  sheet.run(0.5);
  PulledSheet held = bow(1e3);
  const double second = held.set().length[1];
  held.draw(4e-3);
  held.run(0.5);
  EXPECT_EQ(held.set().length[1], second);
  EXPECT_LT(sheet.set().length[1], second - 1e-4) << "the control slides";
}

TEST(ShellThread, SlackPullsNothing) {
  PulledSheet sheet = bow(0.15);
  for (double& length : sheet.set().length) length += 1e-3;
  sheet.run(0.5);
  EXPECT_EQ(sheet.set().tension, (std::vector<double>{0, 0}));
  EXPECT_LT(sheet.maxShift(), 1e-9);
}

TEST(ShellThread, WhatTheWorkspaceRemembersDoesNotMatter) {
  PulledSheet one = bow(0.15), other = bow(0.15);
  for (int k = 0; k < 12; ++k) {
    one.draw(0.5e-3), other.draw(0.5e-3);
    other.workspace = std::make_unique<Workspace>(*other.model);
    ASSERT_EQ(hash(one.state), hash(other.state)) << k;
  }
  EXPECT_GT(one.set().tension[0], 0.05);
}

}  // namespace
}  // namespace vibe::shell_thread_test
