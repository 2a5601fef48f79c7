// What makes a report wrong without the tracker's fault is doubted, and nothing else is. With the number that decides
// switched off, the same frames have wrong reports without a doubt.
#include "bench/doubt_table.hpp"

#include <gtest/gtest.h>

#include "bench/bench_cell.hpp"

namespace vibe::vision::evidence::doubt_table_test {
namespace {

constexpr double kNever = 1e9;

struct Fault {
  const char* scene;
  bool sleeve;
  std::uint64_t seed;
  int frames;
  double TrackerPolicy::*decides;
  double off;
};

const Fault kFaults[] = {
    {"covered_stripe", true, 2, 20, &TrackerPolicy::stripe_seen, 0},
    {"covered_stripe_rest", true, 2, 20, &TrackerPolicy::stripe_seen, 0},
    {"mirrored", true, 1, 24, &TrackerPolicy::stripe_seen, 0},
    {"copy", false, 1, 34, &TrackerPolicy::looks_alike, kNever},
    {"copy", false, 3, 20, &TrackerPolicy::copy_moved, 0},  // seen alone, before the instrument
    {"copy", true, 3, 20, &TrackerPolicy::copy_moved, 0},
    {"flicker_50", false, 1, 16, &TrackerPolicy::strange_light, kNever},
};

class Doubted : public testing::TestWithParam<Fault> {};

TEST_P(Doubted, WhatIsWrong) {
  const Fault& fault = GetParam();
  Cell cell;
  cell.scene = fault.scene;
  const BenchScene bench = makeBenchScene(cell, fault.seed);
  const std::vector<RenderedFrame> drawn = renderFrames(bench, cell, fault.frames);
  TrackerPolicy with;
  if (cell.scene == "covered_stripe_rest") with.copy_moved = 0;  // what rests is unchecked
  TrackerPolicy without = with;
  without.*fault.decides = fault.off;
  DoubtRow row{fault.scene, fault.sleeve}, control = row;
  row.add(bench, drawn, with);
  control.add(bench, drawn, without);
  EXPECT_EQ(row.silent, 0);
  EXPECT_GT(control.silent, 0);
}

std::string nameOf(const testing::TestParamInfo<Fault>& fault) {
  return std::string(fault.param.scene) + (fault.param.sleeve ? "_sleeve_" : "_ring_") +
         std::to_string(fault.param.seed);
}

INSTANTIATE_TEST_SUITE_P(Faults, Doubted, testing::ValuesIn(kFaults), nameOf);

/// Their rows have little weight in the fit, so that it is mostly right.
TEST(DoubtTable, LostRowsAreNoticed) {
  Cell cell;
  cell.scene = "lost_rows_rest";
  const BenchScene bench = makeBenchScene(cell, 1);
  const std::vector<RenderedFrame> drawn = renderFrames(bench, cell, 24);  // every third has lost some
  TrackerPolicy without;
  without.odd_rows = kNever;
  for (const bool sleeve : {false, true}) {
    DoubtRow row{cell.scene, sleeve}, control = row;
    row.add(bench, drawn);
    control.add(bench, drawn, without);
    EXPECT_GE(row.needless, 3);
    EXPECT_EQ(control.needless, 0);
    EXPECT_EQ(row.silent, 0);
  }
}

TEST(DoubtTable, AnOvalSleeveAndAnotherExposureAreDoubtedSoon) {
  for (const DoubtRow& row : doubtTable({"oval", "exposure_3ms"}, {1}, 20)) {
    EXPECT_LE(row.silent, 4) << row.scene;
    if (row.sleeve == (row.scene == "oval")) {
      EXPECT_GT(row.wrong + row.needless, row.reports / 2) << row.scene;
    }
  }
}

TEST(DoubtTable, GoodFramesAreNotDoubted) {
  for (const DoubtRow& row : doubtTable({"moving", "static", "light"}, {3}, 20)) {
    EXPECT_EQ(row.needless, 0) << row.scene;
    EXPECT_EQ(row.silent, 0) << row.scene;
    EXPECT_EQ(row.reports, 20) << row.scene;
  }
}

}  // namespace
}  // namespace vibe::vision::evidence::doubt_table_test
