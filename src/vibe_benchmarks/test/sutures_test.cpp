#include <gtest/gtest.h>

#include <sstream>

#include "suture/outcome_study.hpp"
#include "suture/set_scenario.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::benchmarks::sutures_test {
namespace {

Scene coarseStomach() {
  Scene scene = loadScene(VIBE_CORE_DIR "/scenes/stomach.yaml");
  scene.geometry.particles = 900;
  scene.gas->flow_limit = 5e-4;  // full within a second
  scene.render_surface = false;
  return scene;
}

std::shared_ptr<const Model> modelOf(const Scene& scene) {
  return buildModel(scene, readTextFile(VIBE_DESCRIPTION_DIR "/urdf/scope.urdf", "URDF"));
}

SetLayout twoSmallSets() {
  SetLayout layout;
  layout.sets = 2;
  layout.bites = 4;
  layout.share = 0.2;
  return layout;
}

TEST(Sutures, TwoSetsComeOutCinchedEveryTimeWithTheSameBits) {
  const auto model = modelOf(coarseStomach());
  std::ostringstream log;
  const ScenarioResult result = runScenario(model, twoSmallSets(), "tiny", 2, log);  // throws if bits differ
  ASSERT_EQ(result.rows.size(), 2u);
  for (const ScenarioRow& row : result.rows) {
    EXPECT_EQ(row.set.tear_outs + row.set.breaks + row.set.recoveries + row.set.refusals + row.set.loose, 0);
    EXPECT_EQ(row.set.bites, 4);
    EXPECT_EQ(row.set.technique, static_cast<int>(Technique::U));
    EXPECT_GT(row.set.drawn, 5e-3);
    EXPECT_GE(row.set.tension, 0.9 * model->scene.suture->cinch_tension);
    EXPECT_GT(row.pulling.mean, 0);
    EXPECT_LE(row.pulling.p50, row.pulling.p99);
    EXPECT_LE(row.pulling.p99, row.pulling.max);
  }
  EXPECT_FALSE(result.crossed);
}

TEST(Sutures, SetsTakeVolumeAtThePressureTheyDidNotHaveWithoutThem) {
  const auto model = modelOf(coarseStomach());
  SutureSession session(model);
  session.settle();
  const double before = session.state().volume;
  session.settle();
  EXPECT_NEAR(session.state().volume, before,
              1e-4 * before);  // negative control: without sutures the volume does not change
  const WallPlan plan(model->organ, session.wall());
  for (const auto& set : planSets(plan, twoSmallSets())) session.sew(set);
  session.settle();
  EXPECT_NEAR(session.state().pressure, model->scene.gas->regulated_pressure, 0.01 * session.state().pressure);
  EXPECT_LT(session.state().volume, (1 - 2e-3) * before);
}

TEST(Sutures, AThreadThatHoldsLessThanTheCinchPullsIsReportedBroken) {
  Scene scene = coarseStomach();
  scene.suture->thread_strength = 1;
  SutureSession session(modelOf(scene));
  session.settle();
  const SewnSet set = session.sew(planSets(WallPlan(session.model().organ, session.wall()), twoSmallSets()).front());
  EXPECT_EQ(set.breaks, 1);
  EXPECT_GT(set.max_tension, 0);
}

TEST(Sutures, APlanLiesWhereItSays) {
  const auto model = modelOf(coarseStomach());
  const State state = initialState(*model, 1);
  const SurfaceView wall{model->organ.surface.triangles, state.x, state.y, state.z};
  const WallPlan plan(model->organ, wall);
  EXPECT_GT(plan.length(), 0.15);
  EXPECT_LT(plan.length(), 0.30);
  for (const double along : {0.25, 0.5, 0.75}) {
    const Eigen::Vector3d middle = placeOf(plan.at(along * plan.length(), 0), wall);
    for (const double across : {-0.02, 0.02}) {
      const WallPoint spot = plan.at(along * plan.length(), across);
      EXPECT_NEAR(spot.weight.sum(), 1, 1e-12);
      EXPECT_GT(spot.weight.minCoeff(), -1e-9);
      const Eigen::Vector3d away = placeOf(spot, wall) - middle;
      EXPECT_NEAR(away.norm(), 0.02, 2e-3);  // straight chord of an arc along the wall
      EXPECT_LT(away.x() * across, 0);       // negative: to the front
    }
  }
  // distal first
  const auto alongAxis = [&](double along) {
    const WallPoint spot = plan.at(along, 0);
    return biteAround(*model, wall, spot.triangle, placeOf(spot, wall), 4e-3).along;
  };
  EXPECT_GT(alongAxis(0), alongAxis(plan.length()) + 0.3);
  EXPECT_THROW(plan.at(0.5 * plan.length(), 0.5), Error);
}

TEST(Sutures, ASetIsAU) {
  for (const int bites : {4, 7, 10}) {
    std::vector<Eigen::Vector3d> places;
    for (const Eigen::Vector2d& p : bitesOfU(bites)) places.emplace_back(0.018 * p.x(), 0.018 * p.y(), 0);
    ASSERT_EQ(static_cast<int>(places.size()), bites);
    EXPECT_STREQ(toString(recogniseTechnique(places).technique), "u") << bites;
  }
  EXPECT_THROW(bitesOfU(5), Error);
}

OutcomeTrial coarseTrial() {
  OutcomeTrial trial;
  trial.particles = 900;
  trial.pressure = trial.sewn_at = 1333;
  return trial;
}

TEST(Outcomes, ASleeveAtRestIsSmallerThanTheStomachBefore) {
  const OutcomeRow row = OutcomeStudy(coarseStomach()).run(coarseTrial());
  EXPECT_EQ(row.recognised, kOutcomeSets);
  EXPECT_LE(row.change, kOutcomeChange);
  EXPECT_FALSE(row.crossed);
  EXPECT_GT(row.mean_tension, 0.5);
  EXPECT_GT(reduction(row.before.organ.volume, row.after.organ.volume).value_or(0), 0.05);
  EXPECT_GT(reduction(row.before.organ.mean_area, row.after.organ.mean_area).value_or(0), 0.05);
}

TEST(Outcomes, ThreadThatIsNotDrawnTakesNothingAway) {
  OutcomeTrial trial = coarseTrial();
  trial.drawn = 0;
  const OutcomeRow row = OutcomeStudy(coarseStomach()).run(trial);
  EXPECT_LT(row.drawn, 2e-3);
  EXPECT_NEAR(row.after.organ.volume / row.before.organ.volume, 1, 2e-3);
}

TEST(Outcomes, TrialsChangeOneChoiceAtATime) {
  const Scene scene = coarseStomach();
  const std::vector<OutcomeTrial> quick = outcomeTrials(scene, true), all = outcomeTrials(scene, false);
  ASSERT_EQ(quick.size(), 3u);
  for (const OutcomeTrial& trial : quick) EXPECT_EQ(trial.particles, scene.geometry.particles);
  for (const OutcomeTrial& trial : all) {
    const OutcomeTrial& reference = quick.front();
    const int changed = (trial.particles != reference.particles) + (trial.pressure != reference.pressure) +
                        (trial.sewn_at != trial.pressure) + (trial.thread_friction != reference.thread_friction) +
                        (trial.foundation != reference.foundation) + trial.drawn.has_value();
    EXPECT_EQ(changed, trial.name == "as_cinched" ? 0 : 1) << trial.name;
  }
}

TEST(Sutures, CrossingWallsAreSeen) {
  const auto model = modelOf(coarseStomach());
  State state = initialState(*model, 1);
  EXPECT_FALSE(wallsCross(*model, state));
  for (auto* axis : {&state.x, &state.y, &state.z}) {  // one vertex far out through the other side
    double middle = 0;
    for (double place : *axis) middle += place / model->particle_count;
    (*axis)[300] = middle - 3 * ((*axis)[300] - middle);
  }
  EXPECT_TRUE(wallsCross(*model, state));
}

}  // namespace
}  // namespace vibe::benchmarks::sutures_test
