#include "protocol/command.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "protocol/viewer_message.hpp"

namespace vibe::web::command_test {
namespace {

using Row = std::vector<std::uint8_t>;

template <class T>
void put(Row& row, T value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  row.insert(row.end(), bytes, bytes + sizeof value);
}

std::optional<Command> decode(const Row& row) {
  return decodeCommand(row.data(), row.size());
}

Row drive(std::uint8_t keys) {
  Row row{4, keys, 0, 0};
  put(row, std::uint32_t{77});
  put(row, std::uint32_t{5});
  for (int k = 0; k < 7; ++k) put(row, static_cast<std::int16_t>(k == 1 ? -32768 : 0));
  put(row, std::uint16_t{0});
  for (std::uint32_t k = 0; k < keys; ++k) put(row, 0x57 + k);
  return row;
}

Row replay(double speed, double time) {
  Row row{5, 3, 0, 0, 0, 0, 0, 0};
  put(row, speed);
  put(row, time);
  return row;
}

/// A head and a right hand, each turned by half a turn about x.
Row viewer(std::uint8_t present = 5, std::uint16_t buttons = 1 << 9, float x = 1, float w = 0) {
  Row row{8, present};
  put(row, buttons);
  for (const int stick : {0, 32767, -32768, 0}) put(row, static_cast<std::int16_t>(stick));
  for (int k = 0; k < 3; ++k)
    for (const float number : {x, 2.F, 3.F, 1.F, 0.F, 0.F, w}) put(row, number);
  return row;
}

TEST(Command, DriveSaysAllThatIsHeld) {
  const auto command = decode(drive(2));
  ASSERT_TRUE(command);
  EXPECT_EQ(command->kind, Command::Kind::Drive);
  EXPECT_EQ(command->grant, 77U);
  EXPECT_EQ(command->number, 5U);
  EXPECT_EQ(command->keys, (std::vector<int>{0x57, 0x58}));
  EXPECT_EQ(command->axes[1], -1);  // not beyond
  EXPECT_EQ(command->axes[0], 0);
}

TEST(Command, ViewerSaysWhatIsThere) {
  const auto command = decode(viewer());
  ASSERT_TRUE(command);
  const ViewerState& seen = command->viewer;
  EXPECT_EQ(seen.poses[0], (ViewerState::Pose{1, 2, 3, 1, 0, 0, 0}));
  EXPECT_FALSE(seen.poses[1]);
  EXPECT_TRUE(seen.poses[2]);
  EXPECT_EQ(seen.sticks, (std::array<double, 4>{0, 1, -1, 0}));
  EXPECT_TRUE(seen.buttons[9]);
  EXPECT_FALSE(seen.buttons[0]);
  const Bytes told = encodeViewer(seen), row = viewer();
  ASSERT_EQ(told.size(), 88U);
  EXPECT_EQ(told[1], 5);
  EXPECT_TRUE(std::equal(told.begin() + 4, told.begin() + 32, row.begin() + 12));  // the head, as it came
  EXPECT_EQ(told[32], 0);                                                          // no left hand
}

TEST(Command, ReplayKeepsTheSpeedToTheLastBit) {
  for (const double speed : {0.01, 0.1, 0.25, 4.0, 100.0}) {
    const auto command = decode(replay(speed, 2.3));
    ASSERT_TRUE(command) << speed;
    EXPECT_EQ(command->speed, speed);  // else the page, to which the player tells it, finds none that is called so
    EXPECT_EQ(command->time, 2.3);
  }
  EXPECT_NE(static_cast<double>(0.1F), 0.1);  // which is what could go wrong
}

TEST(Command, OfAnotherLengthIsNone) {
  for (const Row& good :
       {drive(0), drive(16), replay(1, 2), Row{1, 60}, Row{2}, Row{3}, Row{7, 0}, Row(16, 6), viewer()}) {
    EXPECT_TRUE(decode(good)) << int{good[0]};
    Row longer = good, shorter = good;
    longer.push_back(0);
    shorter.pop_back();
    EXPECT_FALSE(decode(longer)) << int{good[0]};
    EXPECT_FALSE(decode(shorter)) << int{good[0]};
  }
}

TEST(Command, OutsideOfItsLimitsIsNone) {
  EXPECT_FALSE(decode(drive(17)));
  EXPECT_FALSE(decode({1, 0}));
  EXPECT_FALSE(decode({1, 61}));
  EXPECT_FALSE(decode({9}));
  EXPECT_FALSE(decode(replay(0, 1)));
  EXPECT_FALSE(decode(replay(std::numeric_limits<double>::quiet_NaN(), 1)));
  EXPECT_FALSE(decode(replay(0.0099, 1)));
  EXPECT_FALSE(decode(replay(1, -1)));
  EXPECT_FALSE(decode(replay(1, std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(decode(viewer(8)));           // a body that nobody has
  EXPECT_FALSE(decode(viewer(5, 1 << 10)));  // a button that no hand has
  EXPECT_FALSE(decode(viewer(1, 0, 101)));   // too far
  EXPECT_FALSE(decode(viewer(1, 0, std::numeric_limits<float>::quiet_NaN())));
  EXPECT_FALSE(decode(viewer(1, 0, 1, 1)));                                    // no rotation
  EXPECT_TRUE(decode(viewer(0, 0, std::numeric_limits<float>::quiet_NaN())));  // nothing is there
  Row key = drive(1);
  key.back() = 0xff;
  EXPECT_FALSE(decode(key));
}

}  // namespace
}  // namespace vibe::web::command_test
