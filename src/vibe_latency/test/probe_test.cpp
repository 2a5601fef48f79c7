// What the probe is made of.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "lamp_watch.hpp"
#include "latency_probe.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::latency::probe_test {
namespace {

std::string contentOf(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(LampWatch, GreenIsLitMagentaIsNotAndAnythingElseIsNoLamp) {
  EXPECT_EQ(lampState(0x00ff00), std::optional<bool>(true));
  EXPECT_EQ(lampState(0xff00ff), std::optional<bool>(false));
  EXPECT_EQ(lampState(0xff00ff00), std::optional<bool>(true));  // with an alpha channel
  for (const unsigned long other : {0x000000UL, 0xffffffUL, 0x00fe00UL, 0xff00feUL, 0x010101UL})
    EXPECT_EQ(lampState(other), std::nullopt);
}

TEST(EventTable, WritesWholeNumbersExactlyAndOnce) {
  const std::string file = ::testing::TempDir() + "events.csv";
  EventTable table(file, "wall,stamp,position");
  table.add({1795514211001749459, 7}, {0.1});
  EXPECT_EQ(contentOf(file), "wall,stamp,position\n");
  table.flush();
  table.flush();
  table.add({-1, 2});
  table.flush();
  EXPECT_EQ(contentOf(file), "wall,stamp,position\n1795514211001749459,7,0.10000000000000001\n-1,2\n");
}

TEST(EventTable, AFolderThatIsNotThereIsSaid) {
  EXPECT_THROW(EventTable("/nowhere/events.csv", "wall"), Error);
}

}  // namespace
}  // namespace vibe::latency::probe_test
