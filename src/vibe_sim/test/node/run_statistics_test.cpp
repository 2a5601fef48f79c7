// What the simulator advises when it falls behind the wall clock.
#include "simulator/run_statistics.hpp"

#include <gtest/gtest.h>

#include "sentences.hpp"

namespace vibe::sim::run_statistics_test {
namespace {

TEST(RunStatistics, TellsLoadOfTheMachineFromCostOfTheSteps) {
  constexpr double kPeriod = 1.0 / 60;
  expectMentions(lagRemedy(0.0019, 0.004, kPeriod), "busy with something else");
  expectMentions(lagRemedy(0.0019, 0.080, kPeriod), "single steps are long");
  expectMentions(lagRemedy(0.030, 0.080, kPeriod), "fewer particles or substeps");
  EXPECT_EQ(std::string(lagRemedy(0.0019, 0.004, kPeriod)).find("particles"), std::string::npos);
}

}  // namespace
}  // namespace vibe::sim::run_statistics_test
