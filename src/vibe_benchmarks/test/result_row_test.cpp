#include "output/result_row.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace vibe::benchmarks::result_row_test {
namespace {

TEST(ResultRow, writesTheAgreedColumns) {
  ResultRow row;
  row.bench_case = "wall, \"thin\"";
  row.method = "implicit";
  row.setting = "60 Hz";
  row.particles = 3618;
  row.motion_error = 0.012;
  row.force_error = std::numeric_limits<double>::infinity();
  row.state_hash = 0xabc;
  row.branch = Branch::Other;
  setTimes({3, 1, 2, 4}, row);
  std::ostringstream out;
  writeCsv({row}, out);
  EXPECT_EQ(out.str(),
            "case,method,setting,particles,threads,ms_p50,ms_p99,ms_max,motion_error,static_error,force_error,"
            "reference_error,energy_drift,state_hash,branch\n"
            "\"wall, \"\"thin\"\"\",implicit,60 Hz,3618,1,2,4,4,0.012,,inf,,,0000000000000abc,other\n");
}

TEST(ResultRow, takesPercentilesFromTheSortedTimes) {
  std::vector<double> values;
  for (int i = 200; i > 0; --i) values.push_back(i);
  const StepTimes times = timesOf(values);
  EXPECT_EQ(times.p50, 100);
  EXPECT_EQ(times.p99, 198);
  EXPECT_EQ(times.max, 200);
}

TEST(ResultRow, printsCsvForPeopleWithTheLongSideDown) {
  testing::internal::CaptureStderr();
  report("", [](std::ostream& out) { out << "name,n\n\"a, b\",1\nc,20\n"; });
  report("", [](std::ostream& out) { out << "name,n,m\nc,20,\n"; });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "name  n \na, b  1 \nc     20\nname  c \nn     20\nm       \n");
}

}  // namespace
}  // namespace vibe::benchmarks::result_row_test
