#include "operator/operator_seat.hpp"

#include <gtest/gtest.h>

namespace vibe::web::operator_seat_test {
namespace {

Command drive(std::uint32_t grant, std::uint32_t number) {
  Command command;
  command.kind = Command::Kind::Drive;
  command.grant = grant;
  command.number = number;
  command.keys = {'W'};
  command.axes[0] = 0.5;
  return command;
}

bool isButton(int key) {
  return key == 'G';
}

TEST(OperatorSeat, HoldsOneAndHearsNobodyElse) {
  OperatorSeat seat(isButton);
  EXPECT_FALSE(seat.receive(1, drive(0, 1), 0));  // nobody drives, and nothing was granted
  EXPECT_TRUE(seat.take(1, 11, 0));
  EXPECT_FALSE(seat.take(2, 22, 0));
  EXPECT_FALSE(seat.receive(2, drive(11, 1), 0));
  EXPECT_TRUE(seat.receive(1, drive(11, 1), 0));
  EXPECT_EQ(seat.keys(), (std::set<int>{'W'}));
  EXPECT_FALSE(seat.leave(2));
  EXPECT_TRUE(seat.leave(1));
  EXPECT_TRUE(seat.keys().empty());
  EXPECT_TRUE(seat.take(2, 22, 0));
}

TEST(OperatorSeat, ReplayedMessagesDoNotCount) {
  OperatorSeat seat(isButton);
  seat.take(1, 11, 0);
  EXPECT_TRUE(seat.receive(1, drive(11, 5), 0));
  EXPECT_FALSE(seat.receive(1, drive(11, 5), 0));  // the same again
  EXPECT_FALSE(seat.receive(1, drive(11, 4), 0));
  EXPECT_FALSE(seat.receive(1, drive(12, 6), 0));  // of another time in the seat
  EXPECT_TRUE(seat.receive(1, drive(11, 6), 0));
}

TEST(OperatorSeat, SilenceLetsGoAndThenEmptiesTheSeat) {
  OperatorSeat seat(isButton);
  seat.take(1, 11, 0);
  seat.receive(1, drive(11, 1), 1);
  seat.tick(1 + 0.9 * kDeadMan);
  EXPECT_FALSE(seat.keys().empty());
  EXPECT_NE(seat.axes()[0], 0);
  seat.tick(1 + 1.1 * kDeadMan);
  EXPECT_TRUE(seat.keys().empty());
  EXPECT_EQ(seat.axes()[0], 0);
  EXPECT_EQ(seat.holder(), 1U);
  EXPECT_TRUE(seat.receive(1, drive(11, 2), 2));  // it speaks again
  EXPECT_FALSE(seat.keys().empty());
  seat.tick(2 + 1.1 * kAbsent);
  EXPECT_EQ(seat.holder(), 0U);
  EXPECT_TRUE(seat.keys().empty());
}

TEST(OperatorSeat, AButtonThatASilenceLetGoWantsANewPress) {
  OperatorSeat seat(isButton);
  seat.take(1, 11, 0);
  Command both = drive(11, 1);
  both.keys = {'G', 'W'};
  seat.receive(1, both, 0);
  seat.tick(1.1 * kDeadMan);
  both.number = 2;
  seat.receive(1, both, 1.2 * kDeadMan);
  EXPECT_EQ(seat.keys(), (std::set<int>{'W'}));  // the joint goes on
  seat.receive(1, drive(11, 3), 0.4);            // G comes up
  both.number = 4;
  seat.receive(1, both, 0.5);
  EXPECT_EQ(seat.keys(), (std::set<int>{'G', 'W'}));
}

TEST(OperatorSeat, AfterALapseNothingGoesOnByItself) {
  OperatorSeat seat(isButton);
  seat.take(1, 11, 0);
  seat.receive(1, drive(11, 1), 0);
  const double later = 1.1 * kLapse;
  seat.receive(1, drive(11, 2), later);
  seat.receive(1, drive(11, 3), later + 0.1);
  EXPECT_TRUE(seat.keys().empty());
  EXPECT_EQ(seat.axes()[0], 0);
  Command nothing = drive(11, 4);
  nothing.keys.clear();
  nothing.axes.fill(0);
  seat.receive(1, nothing, later + 0.2);
  seat.receive(1, drive(11, 5), later + 0.3);
  EXPECT_EQ(seat.keys(), (std::set<int>{'W'}));
  EXPECT_EQ(seat.axes()[0], 0.5);
}

}  // namespace
}  // namespace vibe::web::operator_seat_test
