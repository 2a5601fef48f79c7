#include "vibe_core/metrics/skill_metrics.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "metrics/organs.hpp"

namespace vibe::skill_organ_test {
namespace {

using Kind = Event::Kind;

/// A tube that swells and shrinks on command; no physics.
class OrganSkillTest : public ::testing::Test {
 protected:
  Model model;
  State state;
  std::shared_ptr<OrganRuler> ruler;

  OrganSkillTest() {
    model.organ = test::revolve([](double) { return 0.03; }, 0.3, 32, 32);
    model.scene.step_period = 0.1;
    ruler = std::make_shared<OrganRuler>(model.organ);
    shape(1, 1);
  }
  /// All radii times `across`, the length times `along`.
  void shape(double across, double along) {
    const test::Positions p(model.organ, [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
      return {across * v.x(), across * v.y(), along * v.z()};
    });
    state.x = p.x;
    state.y = p.y;
    state.z = p.z;
  }
  OrganTracker begin() { return OrganTracker(ruler, "", state); }
  void steps(OrganTracker& tracker, int count, std::initializer_list<Kind> kinds = {}) {
    std::vector<Event> events;
    for (Kind kind : kinds) events.emplace_back().kind = kind;
    for (int k = 0; k < count; ++k) tracker.record(model, state, k == 0 ? events : std::vector<Event>());
  }
};

TEST_F(OrganSkillTest, knowsReductionsAgainstTheSetPoint) {
  OrganTracker tracker = begin();
  shape(1.2, 1.1);
  state.pressure = 2000;
  steps(tracker, 1, {Kind::PressureReached});
  EXPECT_EQ(tracker.measures().reference, OrganReference::SetPoint);
  EXPECT_EQ(tracker.measures().reference_pressure, 2000);
  EXPECT_NEAR(*tracker.measures().area_reduction, 0, 1e-12);
  shape(0.9, 0.88);
  state.pressure = 1500;
  steps(tracker, 10);
  const OrganSkill& skill = tracker.measures();
  EXPECT_NEAR(*skill.area_reduction, 1 - 0.5625, 1e-9);  // (0.9 / 1.2)^2
  EXPECT_NEAR(*skill.length_reduction, 1 - 0.8, 1e-9);
  EXPECT_NEAR(*skill.volume_reduction, 1 - 0.5625 * 0.8, 1e-9);
  EXPECT_EQ(skill.pressure, 1500);
  EXPECT_EQ(skill.reference_pressure, 2000);
}

TEST_F(OrganSkillTest, growthIsANegativeReduction) {
  OrganTracker tracker = begin();
  shape(2, 1);
  steps(tracker, 10);
  EXPECT_EQ(tracker.measures().reference, OrganReference::Rest);
  EXPECT_NEAR(*tracker.measures().area_reduction, -3, 1e-9);
}

TEST_F(OrganSkillTest, measuresOncePerSecond) {
  OrganTracker tracker = begin();
  shape(0.5, 1);
  steps(tracker, 9);
  EXPECT_NEAR(*tracker.measures().area_reduction, 0, 1e-12);
  steps(tracker, 1);
  EXPECT_NEAR(*tracker.measures().area_reduction, 0.75, 1e-9);
}

TEST_F(OrganSkillTest, theFirstReferenceStays) {
  for (const auto& [first, reference] :
       {std::pair(Kind::PressureReached, OrganReference::SetPoint), std::pair(Kind::Mark, OrganReference::FirstAct),
        std::pair(Kind::Pierced, OrganReference::FirstAct)}) {
    shape(1, 1);
    OrganTracker tracker = begin();
    shape(0.5, 1);
    steps(tracker, 1, {first});
    shape(0.25, 1);
    steps(tracker, 10, {Kind::PressureReached, Kind::Mark, Kind::Pierced, Kind::Burn});
    EXPECT_EQ(tracker.measures().reference, reference);
    EXPECT_NEAR(*tracker.measures().area_reduction, 0.75, 1e-9);
  }
}

TEST_F(OrganSkillTest, aLoadedStateAtItsSetPointIsTheReference) {
  shape(1.5, 1);
  state.pressure_reached = true;
  EXPECT_EQ(begin().measures().reference, OrganReference::SetPoint);
  EXPECT_NEAR(*begin().measures().area_reduction, 0, 1e-12);
}

TEST_F(OrganSkillTest, aLoadedStateWithBitesOrMarksDoesNotTellWhatWasBefore) {
  shape(0.5, 1);
  state.pressure_reached = true;
  state.procedure.sutures.resize(1);
  OrganTracker sutured = begin();
  state.procedure.sutures.clear();
  state.procedure.grade = {0, 1};
  OrganTracker marked = begin();
  for (OrganTracker* tracker : {&sutured, &marked}) {
    steps(*tracker, 1, {Kind::PressureReached, Kind::Pierced});
    EXPECT_EQ(tracker->measures().reference, OrganReference::Rest);
    EXPECT_NEAR(*tracker->measures().area_reduction, 0.75, 1e-9);
  }
}

TEST_F(OrganSkillTest, hasNoValueWhileAPositionIsLost) {
  OrganTracker tracker = begin();
  state.x[5] = std::numeric_limits<double>::quiet_NaN();
  steps(tracker, 10);
  EXPECT_FALSE(tracker.measures().now || tracker.measures().area_reduction || tracker.measures().volume_reduction);
  shape(0.5, 1);
  steps(tracker, 10);
  EXPECT_NEAR(*tracker.measures().area_reduction, 0.75, 1e-9);
}

TEST_F(OrganSkillTest, withoutARulerSaysWhy) {
  OrganTracker tracker(nullptr, "No axis.", state);
  steps(tracker, 20, {Kind::PressureReached});
  EXPECT_EQ(tracker.measures().fault, "No axis.");
  EXPECT_FALSE(tracker.measures().now || tracker.measures().area_reduction);
}

}  // namespace
}  // namespace vibe::skill_organ_test
