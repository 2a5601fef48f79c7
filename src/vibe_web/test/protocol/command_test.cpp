#include "protocol/command.hpp"

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

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

Row replay(float speed, double time) {
  Row row{5, 3, 0, 0};
  put(row, speed);
  put(row, time);
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

TEST(Command, OfAnotherLengthIsNone) {
  for (const Row& good : {drive(0), drive(16), replay(1, 2), Row{1, 60}, Row{2}, Row{3}, Row{7, 0}, Row(16, 6)}) {
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
  EXPECT_FALSE(decode({8}));
  EXPECT_FALSE(decode(replay(0, 1)));
  EXPECT_FALSE(decode(replay(std::numeric_limits<float>::quiet_NaN(), 1)));
  EXPECT_FALSE(decode(replay(1, -1)));
  EXPECT_FALSE(decode(replay(1, std::numeric_limits<double>::infinity())));
  Row key = drive(1);
  key.back() = 0xff;
  EXPECT_FALSE(decode(key));
}

}  // namespace
}  // namespace vibe::web::command_test
