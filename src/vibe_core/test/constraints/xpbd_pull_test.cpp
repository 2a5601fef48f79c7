// A thread in a wall of shape matching.
#include <gtest/gtest.h>

#include "solver/pulled_sheet.hpp"

namespace vibe::xpbd_pull_test {
namespace {

using test::PulledSheet;
using test::sheetParticle;
using test::sheetScene;

constexpr int kMiddle = test::kColumns / 2, kRow = test::kRows / 2;

PulledSheet threadSheet() {
  return PulledSheet(sheetScene("shape_matching", "thread"), 4);
}

double tissueForce(const PulledSheet& sheet, int particle) {
  const std::size_t n = static_cast<std::size_t>(sheet.model->particle_count);
  std::vector<double> fx(n), fy(n), fz(n);
  sheet.model->tissue->addForces(sheet.state, fx.data(), fy.data(), fz.data());
  return fx[static_cast<std::size_t>(particle)];
}

TEST(XpbdPull, HoldsTheBitesAtTheLengthOfTheThreadWithTheTensionOfTheTissue) {
  PulledSheet sheet = threadSheet();
  sheet.draw(8e-3);
  sheet.run(2);
  const double tension = sheet.set().tension.front(), length = sheet.set().length.front();
  EXPECT_GT(tension, 0.1);
  EXPECT_NEAR(length, 24e-3, 1e-9);
  EXPECT_NEAR(sheet.apart(), length * (1 + tension / sheet.model->scene.suture->thread_stiffness), 1e-6);
  EXPECT_NEAR(tissueForce(sheet, sheetParticle(kMiddle - 4, kRow)), -tension, 0.02 * tension);
  EXPECT_NEAR(tissueForce(sheet, sheetParticle(kMiddle + 4, kRow)), tension, 0.02 * tension);
}

TEST(XpbdPull, SlidesWithoutFrictionThroughABiteBetween) {
  PulledSheet sheet = threadSheet();
  Suture& set = sheet.set();
  Bite between = set.bites.front();
  between.particle = {sheetParticle(kMiddle + 1, kRow + 2)};
  set.bites.insert(set.bites.begin() + 1, between);
  set.length = {30e-3, 30e-3};  // slack
  set.tension = {0, 0};
  sheet.run(0.2);
  EXPECT_EQ(set.tension, (std::vector<double>{0, 0}));
  EXPECT_LT(sheet.maxShift(), 1e-9);
  set.length = {14e-3, 14e-3};
  sheet.run(2);
  EXPECT_GT(set.tension[0], 0.1);
  EXPECT_EQ(set.tension[0], set.tension[1]);
  EXPECT_NEAR(set.length[0] + set.length[1], 28e-3, 1e-9);
  EXPECT_GT(set.length[0], set.length[1] + 2e-3) << "the thread has slid to the longer way";
}

TEST(XpbdPull, SlackThreadLeavesTheTissueAlone) {
  PulledSheet with = threadSheet(), without = threadSheet();
  with.set().length.front() += 1e-3;
  without.state.procedure.sutures.clear();
  for (PulledSheet* sheet : {&with, &without}) sheet->state.vx[sheetParticle(kMiddle, 2)] = 0.01;
  with.run(0.5), without.run(0.5);
  EXPECT_EQ(with.state.x, without.state.x);
  EXPECT_EQ(with.state.z, without.state.z);
  PulledSheet taut = threadSheet();
  taut.state.vx[sheetParticle(kMiddle, 2)] = 0.01;
  taut.set().length.front() -= 1e-3;
  taut.run(0.5);
  EXPECT_NE(taut.state.x, without.state.x);
}

TEST(XpbdPull, KnowsTheWorkOfTheThread) {
  PulledSheet sheet = threadSheet();
  sheet.draw(8e-3);
  sheet.run(1);
  const double stored = sheet.model->tissue->energy(sheet.state);
  EXPECT_GT(stored, 1e-4);
  EXPECT_NEAR(sheet.state.energy.thread_work - sheet.state.energy.damping_loss, stored, 0.05 * stored);
}

TEST(XpbdPull, EqualRunsHaveEqualBits) {
  PulledSheet one = threadSheet(), two = threadSheet();
  one.draw(4e-3), two.draw(4e-3);
  EXPECT_EQ(hash(one.state), hash(two.state));
}

}  // namespace
}  // namespace vibe::xpbd_pull_test
