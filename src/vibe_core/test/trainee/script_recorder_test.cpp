// Aiming at the wall, and scripts that are written by performing them.
#include <gtest/gtest.h>

#include <cmath>

#include "trainee/ik_solution.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/trainee/script_recorder.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe {
namespace {

std::shared_ptr<const Model> smallStomach() {
  static const std::shared_ptr<const Model> model = [] {
    Scene scene;
    scene.geometry.particles = 800;
    scene.attach_oesophagus = scene.attach_duodenum = true;
    scene.gas.emplace();
    scene.foundation.emplace();
    scene.scope.emplace();
    scene.helix.emplace();
    scene.suture.emplace();
    return buildModel(scene, readTextFile(std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf", "URDF"));
  }();
  return model;
}

const char kHeader[] = "name: test\nseed: 3\ntremor: {amplitude: {rotation: 0.1 deg}}\n";

TEST(IkSolution, PlacesAreNamedByAnatomy) {
  const Model& model = *smallStomach();
  for (const double along : {0.4, 0.5, 0.6}) {
    EXPECT_EQ(model.organ.wall[particleAt(model, along, 0)], Wall::GreaterCurvature) << along;
    EXPECT_EQ(model.organ.wall[particleAt(model, along, 1.4)], Wall::Anterior) << along;
    EXPECT_EQ(model.organ.wall[particleAt(model, along, -1.4)], Wall::Posterior) << along;
    EXPECT_NEAR(model.along[particleAt(model, along, 0)], along, 0.021);
  }
  EXPECT_EQ(particleAt(model, 3.0, 0), -1) << "no such place";
}

TEST(IkSolution, DirectionsOfTheWallLeadOutOfTheLumen) {
  const Model& model = *smallStomach();
  const State state = initialState(model, 1);
  for (const double angle : {-1.4, 0.0, 1.4}) {
    const WallPlace place = placeOf(model, state, particleAt(model, 0.5, angle));
    const WallPlace opposite = placeOf(model, state, particleAt(model, 0.5, angle + 3.1));
    EXPECT_NEAR(place.outward.norm(), 1, 1e-12);
    EXPECT_GT(place.outward.dot(place.point - opposite.point), 0) << angle;
  }
}

TEST(IkSolution, ThePointIsReachedWhateverTheDirection) {
  const Model& model = *smallStomach();
  const State state = initialState(model, 1);
  std::array<double, kJointCount> start{};
  start[Insertion] = 0.06;
  const Eigen::Vector3d offset(24e-3, 2.8e-3, -2.2e-3);
  std::vector<Eigen::Isometry3d> poses;
  for (const double along : {0.4, 0.6})
    for (const double angle : {-1.0, 1.0}) {
      const WallPlace place = placeOf(model, state, particleAt(model, along, angle));
      const IkSolution aim = aimAt(model, place.point, place.outward, offset, start);
      EXPECT_LT(aim.miss, 2e-3) << "half the reach of the helix, at " << along << " " << angle;
      model.tool->forwardKinematics(aim.joints, poses);
      EXPECT_NEAR((model.tool_base * poses[model.tip_link] * offset - place.point).norm(), aim.miss, 1e-9);
      for (int j = 0; j < kScopeJointCount; ++j) {
        EXPECT_GE(aim.joints[j], model.tool->limits()[j].lower - 1e-9);
        EXPECT_LE(aim.joints[j], model.tool->limits()[j].upper + 1e-9);
      }
    }
}

TEST(ScriptRecorder, ItsScriptDoesTheSameAgain) {
  ScriptRecorder rehearsal(smallStomach(), kHeader);
  rehearsal.phase("in");
  rehearsal.move(Insertion, 0.08, 0.5);
  rehearsal.hold(Insufflate, 0.5);
  rehearsal.act("{press: helix_grab}");
  rehearsal.move(HelixRotation, 6, 0.5);
  EXPECT_TRUE(rehearsal.happened(Event::Kind::GrabMissed) || rehearsal.happened(Event::Kind::HelixTurned) ||
              rehearsal.events().empty());
  rehearsal.act("{release: helix_grab}");
  rehearsal.wait(0.3);

  const TraineeScript script = TraineeScript::parse(rehearsal.script(), "test");
  const Model& model = rehearsal.model();
  State state = initialState(model, model.scene.seed);
  Workspace workspace(model);
  std::vector<Event> events;
  while (state.step < rehearsal.state().step)
    step(model, state, script.at(static_cast<double>(state.step) * model.scene.step_period), workspace, events);
  EXPECT_GT(state.time, 2);
  EXPECT_EQ(hash(state), hash(rehearsal.state()));
}

TEST(ScriptRecorder, RefusesWhatAScriptCannotSay) {
  ScriptRecorder rehearsal(smallStomach(), kHeader);
  EXPECT_THROW(rehearsal.act("{move: {insertion: 3 kg}, in: 1 s}"), Error);
}

}  // namespace
}  // namespace vibe
