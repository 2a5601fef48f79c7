#include "vibe_core/metrics/session_report.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <sstream>

#include "vibe_core/program/error.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::session_csv_test {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) result.push_back(cell);
  return result;
}

/// The last row by column name.
std::map<std::string, std::string> writtenRow(const State& state, const std::vector<Event>& events) {
  const test::World world(test::bareScene(), test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
  const std::string file = ::testing::TempDir() + "vibe_session_csv_test.csv";
  SessionCsv csv(file);
  csv.write(*world.model, state, events);
  EXPECT_FALSE(std::ifstream(file).is_open());  // not before it is whole
  csv.finish();
  std::ifstream in(file);
  std::string header, row;
  std::getline(in, header);
  std::getline(in, row);
  std::remove(file.c_str());
  const std::vector<std::string> names = cells(header), values = cells(row);
  EXPECT_EQ(names.size(), values.size());
  std::map<std::string, std::string> result;
  for (std::size_t k = 0; k < std::min(names.size(), values.size()); ++k) result[names[k]] = values[k];
  return result;
}

TEST(SessionCsv, aFullDiskIsSaidAtTheEnd) {
  const test::World world(test::bareScene(), test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
  SessionCsv csv("/dev/full");
  EXPECT_THROW(
      {
        csv.write(*world.model, State{}, {});
        csv.finish();
      },
      Error);
}

TEST(SessionCsv, tellsWhereTheProcedureStands) {
  State state;
  state.volume = 1e-3;
  ProcedureState& p = state.procedure;
  p.phase = Phase::Pull;
  p.sutures.resize(2);
  p.sutures[0].bites.resize(3);
  p.sutures[0].tension = {1.5, 2.5};
  p.sutures[1].bites.resize(4);
  p.sutures[1].tension = {0, 2, 1};
  p.blood_lost = 2e-6;
  std::vector<Event> events(2);
  events[0].kind = Event::Kind::Bite;
  events[1].kind = Event::Kind::BleedingMild;
  auto row = writtenRow(state, events);
  EXPECT_EQ(row["volume"], "0.001");
  EXPECT_EQ(row["phase"], "pull");
  EXPECT_EQ(row["bites"], "7");
  EXPECT_EQ(row["sutures"], "2");
  EXPECT_EQ(row["thread_tension"], "2.5");
  EXPECT_EQ(row["blood_lost"], "2e-06");
  EXPECT_EQ(row["events"], "bite;bleeding mild");
}

}  // namespace
}  // namespace vibe::session_csv_test
