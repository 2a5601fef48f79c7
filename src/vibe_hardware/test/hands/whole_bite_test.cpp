// A whole bite by a hand at every kind of device that is shipped: mapping, device, simulator; without ROS.
#include <gtest/gtest.h>

#include <cstdio>

#include "hands/arms_hand.hpp"
#include "hands/pad_hand.hpp"

namespace vibe::hardware::whole_bite_test {
namespace {

using Kind = Event::Kind;

/// Prints the row of docs/hardware.md.
void expectBite(const char* name, test::HandAtDevice& hand) {
  test::BiteOperator person(hand);
  EXPECT_EQ(person.bite(), "") << name;
  for (const Kind kind : {Kind::Grab, Kind::HelixTurned, Kind::Pierced, Kind::Bite, Kind::Release})
    EXPECT_EQ(person.seen().count(kind), 1) << name << ": " << toString(kind);
  for (const Kind mistake : {Kind::Slip, Kind::BiteMissed, Kind::BiteWithdrawn, Kind::Rejected})
    EXPECT_EQ(person.seen().count(mistake), 0) << name << ": " << toString(mistake);
  std::printf("| %s | %.1f | %d | %.2f |\n", name, person.seconds(), hand.commands, person.force());
}

void expectBiteOfArms(const char* name, const std::vector<std::string>& mappings) {
  ArmsHand hand(mappings);
  expectBite(name, hand);
}

TEST(WholeBite, OneDesktopArmWithTwoButtonsAndAPad) {
  ArmsHand hand({"touch"});
  expectBite("`touch.yaml`", hand);
  EXPECT_GE(hand.clutched(), 2);
}

TEST(WholeBite, OneArmThatMeasuresItsJoints) {
  expectBiteOfArms("`joint_arm.yaml`", {"joint_arm"});
}

TEST(WholeBite, OneMasterArmOfTheDvrkWithItsPedals) {
  expectBiteOfArms("`dvrk_mtm.yaml`", {"dvrk_mtm"});
}

TEST(WholeBite, APatientSideArmOfTheDvrk) {
  expectBiteOfArms("`dvrk_psm.yaml`", {"dvrk_psm"});
}

TEST(WholeBite, TwoHandsOneAtTheScopeAndOneAtTheDevice) {
  expectBiteOfArms("`dvrk_left.yaml`, `dvrk_right.yaml`", {"dvrk_left", "dvrk_right"});
}

TEST(WholeBite, APad) {
  PadHand hand("two_stick", twoStickPad());
  expectBite("`two_stick.yaml`", hand);
}

TEST(WholeBite, AFlightStick) {
  PadHand hand("flight_stick", flightStick());
  expectBite("`flight_stick.yaml`", hand);
}

}  // namespace
}  // namespace vibe::hardware::whole_bite_test
