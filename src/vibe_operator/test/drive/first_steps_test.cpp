#include "vibe_operator/drive/drive_keys.hpp"

#include <gtest/gtest.h>

namespace vibe::operating::first_steps_test {
namespace {

DriveSituation atStart() {
  DriveSituation now;
  now.closed = 0.018;
  return now;
}

bool asks(const DriveSituation& now, const std::string& part) {
  return firstStep(now).text.find(part) != std::string::npos;
}

TEST(FirstSteps, LeadThroughTheFirstSet) {
  DriveSituation now = atStart();
  int last = 0;
  const auto expect = [&](const std::string& part) {
    const FirstStep step = firstStep(now);
    EXPECT_NE(step.text.find(part), std::string::npos) << step.text;
    EXPECT_GE(step.number, last) << step.text;
    EXPECT_LE(step.number, kFirstSteps);
    last = step.number;
  };
  expect("Press I");
  now.gas_on = true;
  expect("Hold W");
  now.joints[Insertion] = 0.12;
  expect("Space");
  now.marks = 3;
  expect("Hold E");
  now.joints[HelixAdvance] = 0.026;
  expect("against the wall");
  now.touches = true;
  expect("Press G");
  now.holds = true;
  expect("Hold X");
  now.joints[HelixRotation] = 18.8;
  expect("Hold Q");
  now.joints[HelixAdvance] = 0.005;
  expect("Hold R");
  now.joints[NeedleDriver] = 0.018;
  expect("Press N");
  now.needle_on_arm = false;
  now.set_bites = 1;
  expect("Hold F");
  now.joints[NeedleDriver] = 0;
  expect("press G to release");
  now.holds = false;
  expect("close the empty arm");
  now.joints[NeedleDriver] = 0.018;
  expect("take the needle back");
  now.set_bites = 6;
  now.joints[NeedleDriver] = 0;
  expect("Press T");
  now.needle_loaded = false;
  now.sets_tagged = 1;
  expect("Hold C");
  now.needle_loaded = now.needle_on_arm = true;
  now.sets_tagged = 0;
  now.sets_done = 1;
  expect("complete");
}

TEST(FirstSteps, AnInflatedStomachNeedsNoGas) {
  DriveSituation now = atStart();
  now.pressure = 1300;
  EXPECT_TRUE(asks(now, "Hold W"));
}

TEST(FirstSteps, WhoSkipsMarkingIsNotHeldUp) {
  DriveSituation now = atStart();
  now.gas_on = true;
  now.joints[Insertion] = 0.1;
  now.joints[HelixAdvance] = 0.02;
  now.holds = true;
  EXPECT_TRUE(asks(now, "Hold X"));
}

TEST(FirstSteps, AClosedArmIsOpenedBeforeTheNextGrab) {
  DriveSituation now = atStart();
  now.gas_on = true;
  now.joints[Insertion] = 0.1;
  now.marks = 1;
  now.set_bites = 2;
  now.joints[NeedleDriver] = 0.018;
  EXPECT_TRUE(asks(now, "open the arm"));
}

}  // namespace
}  // namespace vibe::operating::first_steps_test
