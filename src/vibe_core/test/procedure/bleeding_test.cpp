#include "procedure/procedure.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "procedure/procedure_bench.hpp"

namespace vibe::bleeding_test {
namespace {

using Kind = Event::Kind;

Model modelWith(double mild, double brisk) {
  Model model;
  model.scene.step_period = 0.25;
  model.scene.bleeding = BleedingScene{};
  model.scene.bleeding->mild_probability = mild;
  model.scene.bleeding->brisk_probability = brisk;
  return model;
}

std::vector<Kind> outcomes(const Model& model, int bites, std::uint64_t seed) {
  State state;
  state.random = seed;
  std::vector<Kind> kinds;
  for (int bite = 0; bite < bites; ++bite) {
    std::vector<Event> events;
    bleedFromBite(model, 0, bite, 5, state, {state, events});
    kinds.push_back(events.empty() ? Kind::Warning : events.front().kind);
  }
  return kinds;
}

long count(const std::vector<Kind>& kinds, Kind kind) {
  return std::count(kinds.begin(), kinds.end(), kind);
}

// One step of time; the events of it.
std::vector<Event> update(const Model& model, State& state) {
  std::vector<Event> events;
  ++state.step;
  state.time = static_cast<double>(state.step) * model.scene.step_period;
  updateBleedings(model, state, {state, events});
  return events;
}

TEST(Bleeding, HappensAsOftenAsTheSceneSays) {
  const int n = 20000;
  for (const auto& [mild, brisk] : {std::pair{0.25, 0.03}, {0.0, 0.5}, {0.9, 0.1}}) {
    const auto kinds = outcomes(modelWith(mild, brisk), n, 11);
    const auto spread = [&](double p) { return 4 * std::sqrt(n * p * (1 - p)) + 1e-9; };
    EXPECT_NEAR(static_cast<double>(count(kinds, Kind::BleedingMild)), n * mild, spread(mild));
    EXPECT_NEAR(static_cast<double>(count(kinds, Kind::BleedingBrisk)), n * brisk, spread(brisk));
  }
}

TEST(Bleeding, IsTheSameForASeedAndAnotherForAnother) {
  const Model model = modelWith(0.25, 0.03);
  EXPECT_EQ(outcomes(model, 200, 1), outcomes(model, 200, 1));
  EXPECT_NE(outcomes(model, 200, 1), outcomes(model, 200, 2));
}

TEST(Bleeding, OfABiteDoesNotDependOnWhatTheBitesBeforeItDid) {
  const auto some = outcomes(modelWith(0.25, 0.03), 500, 3);
  const auto more = outcomes(modelWith(0.6, 0.03), 500, 3);
  EXPECT_NE(some, more);
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(some[k] == Kind::BleedingBrisk, more[k] == Kind::BleedingBrisk) << k;
    if (some[k] == Kind::BleedingMild) {
      EXPECT_EQ(more[k], Kind::BleedingMild) << k;
    }
  }
}

TEST(Bleeding, WithoutItsPartOfTheSceneDrawsNothing) {
  Model model = modelWith(1, 0);
  model.scene.bleeding.reset();
  State state;
  state.random = 42;
  std::vector<Event> events;
  bleedFromBite(model, 0, 0, 5, state, {state, events});
  updateBleedings(model, state, {state, events});
  EXPECT_EQ(state.random, 42u);
  EXPECT_TRUE(events.empty() && state.procedure.bleedings.empty());
}

TEST(Bleeding, MildStopsByItselfAfterRateTimesDuration) {
  const Model model = modelWith(1, 0);
  State state;
  std::vector<Event> events;
  bleedFromBite(model, 2, 3, 5, state, {state, events});
  ASSERT_EQ(state.procedure.bleedings.size(), 1u);
  int stopped_at = 0;
  for (int step = 1; step <= 400 && stopped_at == 0; ++step)
    for (const Event& event : update(model, state))
      if (event.kind == Kind::BleedingStopped) stopped_at = step;
  EXPECT_EQ(stopped_at, 240) << "60 s of a quarter each";
  const double want = model.scene.bleeding->mild_rate * 60;
  EXPECT_NEAR(state.procedure.bleedings[0].amount, want, 1e-9 * want);
  EXPECT_NEAR(state.procedure.blood_lost, want, 1e-9 * want);
  for (int step = 0; step < 100; ++step) EXPECT_TRUE(update(model, state).empty());
  EXPECT_NEAR(state.procedure.blood_lost, want, 1e-9 * want);
}

TEST(Bleeding, BriskIsOverdueOnceAndGoesOnUntilTheSetIsCinched) {
  const Model model = modelWith(0, 1);
  State state;
  std::vector<Event> events;
  bleedFromBite(model, 0, 0, 5, state, {state, events});
  bleedFromBite(model, 1, 0, 6, state, {state, events});
  int overdue = 0, first = 0;
  for (int step = 1; step <= 800; ++step)
    for (const Event& event : update(model, state)) {
      ASSERT_EQ(event.kind, Kind::BleedingOverdue);
      ++overdue;
      if (first == 0) first = step;
    }
  EXPECT_EQ(overdue, 2);
  EXPECT_EQ(first, 360) << "90 s of a quarter each";
  const double lost = state.procedure.blood_lost;
  EXPECT_NEAR(lost, 2 * model.scene.bleeding->brisk_rate * 200, 1e-9 * lost);
  events.clear();
  stopBleedings(0, state, {state, events});
  ASSERT_EQ(events.size(), 1u) << "only of its own set";
  EXPECT_EQ(events.front().kind, Kind::BleedingStopped);
  update(model, state);
  EXPECT_NEAR(state.procedure.blood_lost - lost, model.scene.bleeding->brisk_rate * 0.25, 1e-9 * lost);
}

TEST(Bleeding, KeepsItsPlaceWhenABiteTearsOut) {
  ProcedureState procedure;
  for (int bite = 0; bite < 4; ++bite) {
    procedure.bleedings.emplace_back();
    procedure.bleedings.back().suture = bite == 3 ? 1 : 0;
    procedure.bleedings.back().bite = bite;
  }
  forgetBite(0, 1, procedure);
  EXPECT_EQ(procedure.bleedings[0].bite, 0);
  EXPECT_EQ(procedure.bleedings[1].bite, -1);
  EXPECT_EQ(procedure.bleedings[2].bite, 1);
  EXPECT_EQ(procedure.bleedings[3].bite, 3) << "of another set";
}

}  // namespace
}  // namespace vibe::bleeding_test
