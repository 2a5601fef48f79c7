// A trainee that looks: it reaches its goals on an organ that it has not seen before, and gives up with a reason.
#include "vibe_core/trainee/trainee.hpp"

#include <gtest/gtest.h>

#include "vibe_core/files/files.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::trainee_test {
namespace {

std::shared_ptr<const Model> stomach() {
  static const std::shared_ptr<const Model> model = [] {
    Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/stomach.yaml");
    scene.scope->compliance.emplace();
    scene.marking.reset();
    return buildModel(scene, readTextFile(std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf", "URDF"));
  }();
  return model;
}

struct Session {
  explicit Session(const Skill& skill = Skill::expert(), std::uint64_t seed = 1)
      : simulation(stomach()), trainee(stomach(), skill, seed) {}

  void perform(double limit = 60) {
    while (!trainee.done() && simulation.time() < limit) simulation.step(trainee.next(observe(simulation)));
  }

  Simulation simulation;
  Trainee trainee;
};

TEST(Trainee, InsufflatesAndBitesWhereItIsTold) {
  Session session;
  session.trainee.add(InsufflateGoal{});
  session.trainee.add(BiteGoal{{0.5, 0.3, 0, 0}});
  session.perform();
  ASSERT_EQ(session.trainee.results().size(), 2u);
  EXPECT_TRUE(session.trainee.results()[0].reached) << session.trainee.results()[0].reason;
  EXPECT_TRUE(session.trainee.results()[1].reached) << session.trainee.results()[1].reason;
  const ProcedureState& procedure = session.simulation.state().procedure;
  ASSERT_EQ(procedure.sutures.size(), 1u);
  ASSERT_EQ(procedure.sutures[0].bites.size(), 1u);
  const Bite& bite = procedure.sutures[0].bites[0];
  EXPECT_TRUE(bite.fullThickness());
  EXPECT_TRUE(procedure.needle_on_arm) << "ready for the next";
  // aim error, and how far beside its target a first try may be
  const Organ& organ = stomach()->organ;
  const AnatomicalMap map(organ, organ.surface.vertices);
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < bite.particle.size(); ++k)
    place += bite.weight[k] * organ.surface.vertices[bite.particle[k]];
  EXPECT_LT((place - map.position(map.at(0.5, 0.3))).norm(), 8e-3);
}

TEST(Trainee, LooksAtPlaces) {
  Session session;
  session.trainee.add(InsufflateGoal{});
  const Place back{0.6, -M_PI / 2, 0, 0}, front{0.35, M_PI / 2, 0, 0};
  session.trainee.add(InspectGoal{back});
  session.trainee.add(InspectGoal{front});
  session.perform();
  for (std::size_t k = 1; k < 3; ++k)
    EXPECT_TRUE(session.trainee.results()[k].reached) << session.trainee.results()[k].reason;
  // the last place is before the tip, the first one is not
  const Observation seen = observe(session.simulation);
  const AnatomicalMap map(stomach()->organ, seen.wall);
  const auto offAxis = [&](const Place& place) {
    const Eigen::Vector3d way = map.position(map.at(place.along, place.around)) - seen.tip;
    return std::acos(way.normalized().dot(seen.tip_turn * Eigen::Vector3d::UnitX()));
  };
  EXPECT_LT(offAxis(front), 0.87);
  EXPECT_GT(offAxis(back), 0.87);
}

TEST(Trainee, LooksEverywhereUntilEnoughIsSeenOrItsPatienceIsOver) {
  Session session;
  session.trainee.add(InsufflateGoal{});
  session.trainee.add(SurveyGoal{0.8, Region::Body});
  session.trainee.add(SurveyGoal{1.0, {}, 60e-3, 2});
  session.perform();
  const std::vector<GoalResult>& results = session.trainee.results();
  ASSERT_EQ(results.size(), 3u);
  EXPECT_TRUE(results[1].reached) << results[1].reason;
  EXPECT_FALSE(results[2].reached) << "nobody sees all in two seconds";
  EXPECT_NE(results[2].reason.find("not seen: "), std::string::npos) << results[2].reason;
}

TEST(Trainee, TheSameSeedMovesTheSameWay) {
  const auto hashOf = [](std::uint64_t seed) {
    Session session(Skill::expert(), seed);
    session.trainee.add(InsufflateGoal{2});
    session.trainee.add(BiteGoal{{0.5, 0, 0, 0}});
    session.perform(3);
    return session.simulation.hash();
  };
  EXPECT_EQ(hashOf(1), hashOf(1));
  EXPECT_NE(hashOf(1), hashOf(2));
}

TEST(Trainee, ActsAfterItsReactionTime) {
  Skill skill;
  skill.reaction_time = 0.5;
  skill.tremor.scale = 0;
  Session session(skill);
  session.trainee.add(InsufflateGoal{1});
  int first = -1;
  for (int k = 0; k < 120 && first < 0; ++k)
    if (session.simulation.step(session.trainee.next(observe(session.simulation)));
        session.simulation.input().joints[Insertion] != session.simulation.model().tool->limits()[Insertion].lower)
      first = k;
  EXPECT_NEAR(first * session.simulation.stepPeriod(), 0.5, 2.5 * session.simulation.stepPeriod());
}

TEST(Trainee, GivesUpWithAReasonAndGoesOn) {
  Session session;
  session.trainee.add(InsufflateGoal{0.5});  // far too little time
  session.trainee.add(MarkGoal{});           // the scene has no argon beam
  session.trainee.add(CinchGoal{});          // there is no bite
  session.trainee.add(WaitGoal{0.1});
  session.perform(20);
  ASSERT_TRUE(session.trainee.done());
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(session.trainee.results()[k].reached) << k;
    EXPECT_FALSE(session.trainee.results()[k].reason.empty()) << k;
  }
  EXPECT_TRUE(session.trainee.results()[3].reached);
}

std::shared_ptr<const Model> modelOf(const Scene& scene) {
  const std::string urdf = std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf";
  return buildModel(scene, scene.scope ? readTextFile(urdf, "URDF") : "");
}

TEST(Trainee, NeedsAScope) {
  Scene scene;
  scene.geometry.particles = 500;
  EXPECT_THROW(Trainee(modelOf(scene), Skill::expert(), 1), Error);
}

TEST(Trainee, AnOrganWithoutAnatomyIsAReasonNotACrash) {
  Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/sphere.yaml");
  ScopeScene& scope = scene.scope.emplace();
  scope.base_from_anatomy = false;
  scene.helix.emplace();
  scene.suture.emplace();
  const auto model = modelOf(scene);
  Simulation simulation(model);
  Trainee trainee(model, Skill::expert(), 1);
  trainee.add(BiteGoal{});
  SutureSetGoal impossible;
  impossible.bites = 1;
  trainee.add(impossible);
  trainee.add(WaitGoal{0.1});
  for (int k = 0; k < 120 && !trainee.done(); ++k) simulation.step(trainee.next(observe(simulation)));
  ASSERT_TRUE(trainee.done());
  EXPECT_NE(trainee.results()[0].reason.find("landmarks"), std::string::npos) << trainee.results()[0].reason;
  EXPECT_FALSE(trainee.results()[1].reached);
  EXPECT_TRUE(trainee.results()[2].reached);
}

TEST(Skill, ALineFromExpertToNovice) {
  const Skill expert = Skill::expert(), novice = Skill::novice();
  EXPECT_EQ(between(expert, novice, 0).aim_error, expert.aim_error);
  EXPECT_EQ(between(expert, novice, 1).aim_error, novice.aim_error);
  EXPECT_EQ(between(expert, novice, 1).attempts, novice.attempts);
  EXPECT_DOUBLE_EQ(between(expert, novice, 0.5).foresight, 0.5);
  EXPECT_DOUBLE_EQ(between(expert, novice, 0.25).look_time, 0.75 * expert.look_time + 0.25 * novice.look_time);
  double last = 0;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Skill skill = between(expert, novice, part);
    EXPECT_GT(skill.aim_error, last);
    last = skill.aim_error;
  }
}

}  // namespace
}  // namespace vibe::trainee_test
