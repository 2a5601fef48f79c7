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

TEST(OperatorSeat, HoldsOneAndHearsNobodyElse) {
  OperatorSeat seat;
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
  OperatorSeat seat;
  seat.take(1, 11, 0);
  EXPECT_TRUE(seat.receive(1, drive(11, 5), 0));
  EXPECT_FALSE(seat.receive(1, drive(11, 5), 0));  // the same again
  EXPECT_FALSE(seat.receive(1, drive(11, 4), 0));
  EXPECT_FALSE(seat.receive(1, drive(12, 6), 0));  // of another time in the seat
  EXPECT_TRUE(seat.receive(1, drive(11, 6), 0));
}

TEST(OperatorSeat, SilenceLetsGoAndThenEmptiesTheSeat) {
  OperatorSeat seat;
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

}  // namespace
}  // namespace vibe::web::operator_seat_test
