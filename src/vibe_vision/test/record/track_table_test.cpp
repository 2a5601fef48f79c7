#include "vibe_vision/record/track_table.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "vibe_core/program/error.hpp"

namespace vibe::vision::track_table_test {
namespace {

VisionConfig twoInstruments() {
  VisionConfig config;
  config.instruments.resize(2);
  config.instruments[0].name = "helix";
  config.instruments[1].name = "driver, left";
  return config;
}

Measurement tracked(double slide) {
  Measurement m;
  m.reason = LostReason::None;
  m.slide = slide;
  m.rotation = std::nan("");
  m.covariance(0, 0) = 1e-12;
  m.score = 0.9;
  m.visible = 1;
  return m;
}

Measurement lost(LostReason reason) {
  Measurement m;
  m.reason = reason;
  m.slide = m.rotation = std::nan("");
  return m;
}

std::vector<std::string> linesOf(const std::string& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(TrackTable, HasARowPerFrameAndInstrumentWithAsManyFieldsAsColumns) {
  const std::string file = testing::TempDir() + "track_table_" + std::to_string(getpid()) + ".csv";
  TrackTable table(file, twoInstruments());
  Frame frame;
  frame.sequence = 7;
  frame.stamp = 1.5e9 + 0.25;
  Measurement turning = tracked(0.0123456789);
  turning.rotation = 2;
  turning.covariance(1, 1) = 4e-6;
  table.add(frame, {turning, lost(LostReason::Occluded)});
  table.close();
  const std::vector<std::string> lines = linesOf(file);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].rfind("sequence,stamp,instrument,tracked,reason,slide,slide_deviation,rotation,", 0), 0U);
  EXPECT_EQ(lines[1].rfind("7,1500000000.250000000,helix,1,,0.0123456789,1e-06,2,0.002,0.9,1,", 0), 0U) << lines[1];
  EXPECT_EQ(lines[2].rfind("7,1500000000.250000000,\"driver, left\",0,occluded,,,,,0,", 0), 0U) << lines[2];
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  EXPECT_EQ(commas(lines[1]), commas(lines[0]));
  EXPECT_EQ(commas(lines[2]), commas(lines[0]) + 1);  // the one in the name
  unlink(file.c_str());
}

TEST(TrackTable, AFolderThatIsNotThereIsAnError) {
  EXPECT_THROW(TrackTable("/nowhere/table.csv", twoInstruments()), Error);
}

TEST(TrackSummary, CountsReasonsAndTimes) {
  TrackSummary summary(twoInstruments());
  for (int i = 0; i < 3; ++i) summary.add({tracked(0), lost(LostReason::Dark)}, 1e-3);
  summary.add({lost(LostReason::Jump), lost(LostReason::Dark)}, 5e-3);
  const std::string text = summary.text();
  EXPECT_NE(text.find("helix: tracked in 3 of 4 frames, 75.00 %"), std::string::npos) << text;
  EXPECT_NE(text.find(std::string("lost in 1 frames, 25.00 %: ") + toText(LostReason::Jump)), std::string::npos);
  EXPECT_NE(text.find("driver, left: tracked in 0 of 4 frames"), std::string::npos);
  EXPECT_NE(text.find("1.000 ms median, 5.000 ms p99, 5.000 ms max"), std::string::npos) << text;
}

TEST(TrackSummary, EveryReasonHasAWordOfItsOwn) {
  std::vector<std::string> words;
  for (int i = 0; i <= static_cast<int>(LostReason::NoFrame); ++i) {
    words.emplace_back(toWord(static_cast<LostReason>(i)));
    EXPECT_EQ(std::count(words.begin(), words.end(), words.back()), 1) << words.back();
    EXPECT_NE(words.back(), "unknown");
  }
}

}  // namespace
}  // namespace vibe::vision::track_table_test
