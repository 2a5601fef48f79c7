#include "vibe_operator/messages/reference_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vibe::operating::reference_values_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

const ShownMeasure& find(std::string_view label) {
  const auto& all = measures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ShownMeasure& m) { return m.label == label; });
  if (found == all.end()) throw std::runtime_error("no measure " + std::string(label));
  return *found;
}

double valueOf(const std::string& label, const vibe_msgs::ProcedureState& state, const vibe_msgs::SkillMetrics& skill,
               const vibe_msgs::SutureArray* sutures = nullptr) {
  return find(label).value({state, skill, sutures});
}

vibe_msgs::Suture makeSet(std::uint8_t stage, std::size_t bites, std::uint32_t tear_outs = 0) {
  vibe_msgs::Suture suture;
  suture.stage = stage;
  suture.bites.resize(bites);
  suture.tear_outs = tear_outs;
  return suture;
}

TEST(ReferenceValues, everyMeasureIsComplete) {
  std::set<std::string> labels;
  for (const ShownMeasure& measure : measures()) {
    SCOPED_TRACE(measure.label);
    EXPECT_TRUE(labels.insert(measure.label).second) << "twice";
    EXPECT_NE(measure.value, nullptr);
    EXPECT_EQ(measure.meaning.back(), '.');
    EXPECT_GT(measure.bar_end, 0);
    if (measure.source.empty()) continue;
    EXPECT_LE(measure.low, measure.high);
    EXPECT_LE(measure.low, measure.bar_end) << "the range is not on the bar";
    // a source is a paper: a year, and where it appeared
    EXPECT_TRUE(measure.source.find("20") != std::string::npos || measure.source.find("10.") != std::string::npos);
    EXPECT_NE(explain(measure).find(measure.source), std::string::npos);
  }
}

TEST(ReferenceValues, unitsAreConverted) {
  vibe_msgs::ProcedureState state;
  vibe_msgs::SkillMetrics skill;
  skill.area_reduction = 0.346;
  state.blood_lost = 12e-6;
  state.pressure = 1333.22;
  skill.bite_spacing_mean = 0.021;
  skill.full_thickness_share = 0.75;
  skill.time = 120;
  skill.time_above = 3;
  EXPECT_NEAR(valueOf("Area reduction", state, skill), 34.6, 1e-9);
  EXPECT_NEAR(valueOf("Blood lost", state, skill), 12, 1e-9);
  EXPECT_NEAR(valueOf("Gas pressure", state, skill), 10, 1e-9);
  EXPECT_NEAR(valueOf("Bite spacing", state, skill), 21, 1e-9);
  EXPECT_NEAR(valueOf("Full thickness", state, skill), 75, 1e-9);
  EXPECT_NEAR(valueOf("Time", state, skill), 2, 1e-9);
  EXPECT_NEAR(valueOf("Time above 5 N", state, skill), 2.5, 1e-9);
}

TEST(ReferenceValues, whatIsNotDefinedHasNoValue) {
  const vibe_msgs::ProcedureState state;
  const vibe_msgs::SkillMetrics nothing_done;
  for (const char* label : {"Bites per set", "Off the body", "Time above 5 N", "Max force"})
    EXPECT_TRUE(std::isnan(valueOf(label, state, nothing_done))) << label;
  vibe_msgs::SkillMetrics touched;
  touched.contact_time = 1;
  touched.time = 1;
  EXPECT_EQ(valueOf("Max force", state, touched), 0);
  EXPECT_EQ(valueOf("Time above 5 N", state, touched), 0);
}

TEST(ReferenceValues, openSetsAreNotAveraged) {
  vibe_msgs::SutureArray sutures;
  sutures.sutures = {makeSet(vibe_msgs::Suture::CINCHED, 7), makeSet(vibe_msgs::Suture::TAGGED, 8, 1),
                     makeSet(vibe_msgs::Suture::OPEN, 1)};
  EXPECT_NEAR(valueOf("Bites per set", {}, {}, &sutures), 8,
              1e-12);  // one of nine tore out and was a bite all the same
  sutures.sutures.erase(sutures.sutures.begin(), sutures.sutures.begin() + 2);
  EXPECT_TRUE(std::isnan(valueOf("Bites per set", {}, {}, &sutures)));
}

TEST(ReferenceValues, ratesEachSideOfARange) {
  const ShownMeasure& bites = find("Bites per set");
  EXPECT_EQ(rate(bites, 5.9, false), Rating::Outside);
  EXPECT_EQ(rate(bites, 6, false), Rating::Within);
  EXPECT_EQ(rate(bites, 9, false), Rating::Within);
  EXPECT_EQ(rate(bites, 9.1, false), Rating::Outside);
  EXPECT_EQ(rate(bites, kNaN, false), Rating::NoValue);
  EXPECT_EQ(rate(find("Bite spacing"), 20, false), Rating::NoReference);
}

TEST(ReferenceValues, whatGrowsHasTimeUntilTheEnd) {
  const ShownMeasure& area = find("Area reduction");
  EXPECT_EQ(rate(area, 9.4, false), Rating::NotYet);
  EXPECT_EQ(rate(area, 9.4, true), Rating::Outside);
  EXPECT_EQ(rate(area, 34.6, false), Rating::Within);
  EXPECT_EQ(rate(area, 70, true), Rating::Within);
  EXPECT_EQ(rate(find("Bites per set"), 3, false), Rating::Outside) << "does not grow";
}

TEST(ReferenceValues, pullingIsTooHardAboveFiveNewton) {
  EXPECT_EQ(rate(kPullingForce, 5, false), Rating::Within);
  EXPECT_EQ(rate(kPullingForce, 5.1, false), Rating::Outside);
}

TEST(ReferenceValues, rangesInWords) {
  EXPECT_EQ(rangeText(find("Bites per set")), "6.0 to 9.0");
  EXPECT_EQ(rangeText(find("Area reduction")), "at least 34.6 %");
  EXPECT_EQ(rangeText(find("Max force")), "at most 8.0 N");
  EXPECT_EQ(rangeText(find("Sets proximal")), "100 %");
  EXPECT_EQ(rangeText(find("Bite spacing")), "");
  EXPECT_NE(explain(find("Bite spacing")).find("No reference is published"), std::string::npos);
}

TEST(ReferenceValues, barsStayWithinThemselves) {
  const ShownMeasure& bites = find("Bites per set");  // 6 to 9 of 14
  const BarShape shape = barShape(bites, 7);
  EXPECT_TRUE(shape.has_range && shape.has_value && !shape.beyond);
  EXPECT_NEAR(shape.range_begin, 6.0 / 14, 1e-12);
  EXPECT_NEAR(shape.range_end, 9.0 / 14, 1e-12);
  EXPECT_NEAR(shape.value, 0.5, 1e-12);
  EXPECT_TRUE(barShape(bites, 15).beyond);
  EXPECT_EQ(barShape(bites, 15).value, 1);
  EXPECT_TRUE(barShape(bites, -1).beyond);
  EXPECT_EQ(barShape(bites, -1).value, 0);
  EXPECT_FALSE(barShape(bites, kNaN).has_value);
  EXPECT_EQ(barShape(find("Area reduction"), 10).range_end, 1) << "an open range goes to the end";
  EXPECT_FALSE(barShape(find("Bite spacing"), 10).has_range);
}

}  // namespace
}  // namespace vibe::operating::reference_values_test
