#include "numbers/number_study.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/program/error.hpp"

namespace vibe::vision::evidence::number_study_test {
namespace {

TEST(TrackerNumbers, HaveAMeaningAndAReasonEachAndCanBeShifted) {
  EXPECT_GT(trackerNumbers().size(), 30U);
  for (const TrackerNumber& number : trackerNumbers()) {
    EXPECT_FALSE(number.meaning.empty() || number.reason.empty()) << number.name;
    for (const double factor : {0.8, 1.2}) {
      TrackerPolicy policy;
      number.scale(policy, factor);
      EXPECT_EQ(number.of(policy) > number.of({}), factor > 1) << number.name;
    }
  }
}

StudyOptions study(const std::string& number, double factor) {
  StudyOptions options;
  options.frames = 6;
  options.scenes = {"static"};
  options.numbers = {number};
  options.factors = {factor};
  return options;
}

TEST(NumberStudy, SaysWhatALimitThatNothingPassesLoses) {
  const std::vector<NumberEffect> effects = studyNumbers(study("max_black", 0), [](const std::string&) {});
  ASSERT_EQ(effects.size(), 1U);
  EXPECT_EQ(effects[0].tracked, -12);      // ring and sleeve
  EXPECT_EQ(effects[0].search_found, -4);  // two searches each
}

TEST(NumberStudy, SaysThatNothingMovesWhereNothingDoes) {
  const NumberEffect e = studyNumbers(study("max_black", 1), [](const std::string&) {}).at(0);
  EXPECT_TRUE(e.tracked == 0 && e.search_found == 0 && e.wrong == 0 && e.phantom == 0 && e.doubted == 0);
  EXPECT_LT(std::abs(e.error), 5e-4);
}

TEST(NumberStudy, RefusesAnUnknownNumber) {
  EXPECT_THROW(studyNumbers(study("luck", 1.2), [](const std::string&) {}), Error);
}

}  // namespace
}  // namespace vibe::vision::evidence::number_study_test
