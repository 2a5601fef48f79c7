#include "publishing/warning_gate.hpp"

#include <gtest/gtest.h>

#include <random>

namespace vibe::sim::warning_gate_test {
namespace {

TEST(WarningGate, OneOfAKindPassesInASecond) {
  WarningGate gate;
  EXPECT_TRUE(gate.admits("A message on scope/servo_cp from /a is ignored: its frame is 'map'.", 5));
  EXPECT_FALSE(gate.admits("A message on scope/servo_cp from /a is ignored: its frame is 'base 7'.", 5.5));
  EXPECT_TRUE(gate.admits("A message on scope/servo_cv from /a is ignored: its frame is 'map'.", 5.5));
  EXPECT_TRUE(gate.admits("A message on scope/servo_cp from /a is ignored: its stamp is 3 s ahead.", 5.5));
  EXPECT_FALSE(gate.admits("A message on scope/servo_cp from /a is ignored: its stamp is 412.5 s ahead.", 5.9));
  EXPECT_TRUE(gate.admits("A message on scope/servo_cp from /a is ignored: its frame is 'map'.", 6));
  EXPECT_TRUE(gate.admits("It is the simulator's time, not 'a'.", 6));
  EXPECT_FALSE(gate.admits("It is the simulator's time, not 'b'.", 6));
}

TEST(WarningGate, NoFloodPassesWhateverItSays) {
  std::mt19937 random(3);
  WarningGate gate;
  std::size_t told = 0;
  for (int k = 0; k < 20000; ++k) {  // 1 kHz
    std::string sentence = "its frame is '";
    for (int c = 0; c < 12; ++c) sentence += static_cast<char>(random() % 95 + 32);
    told += gate.admits(sentence + "'; give world.", 1e-3 * k) ? 1 : 0;
  }
  EXPECT_LE(told, 20 * kMostWarnings);
  EXPECT_GE(told, 20u);
}

}  // namespace
}  // namespace vibe::sim::warning_gate_test
