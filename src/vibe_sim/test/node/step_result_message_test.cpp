// What a node perceives from messages has the bits of what a program without ROS perceives.
#include "conversions/session_message.hpp"

#include <gtest/gtest.h>

#include "conversions/tissue_message.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace vibe::sim::step_result_message_test {
namespace {

std::shared_ptr<const Model> smallStomach() {
  static const std::shared_ptr<const Model> model = vibe::loadModel("node/scenes/small_stomach.yaml");
  return model;
}

/// What a subscriber has after the last step.
Observation fromMessages(const TimedSimulation& simulation) {
  ParticleCloud cloud(simulation.model(), simulation.state(), simulation.revision());
  Observation seen = readStepResult(makeStepResult(simulation, false));
  seen.wall = readWall(cloud.update(simulation.model(), simulation.state(), simulation.now()));
  return seen;
}

void expectSame(const Observation& a, const Observation& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.wall, b.wall);
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.tip, b.tip);
  EXPECT_EQ(a.tip_turn.coeffs(), b.tip_turn.coeffs());
  EXPECT_EQ(a.helix, b.helix);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(std::make_tuple(a.pressure_reached, a.grips, a.arm_closed, a.needle_on_arm, a.needle_loaded),
            std::make_tuple(b.pressure_reached, b.grips, b.arm_closed, b.needle_on_arm, b.needle_loaded));
  EXPECT_EQ(std::make_tuple(a.sets, a.bites, a.stage, a.tension), std::make_tuple(b.sets, b.bites, b.stage, b.tension));
}

void expectSameEvents(const Observation& a, const Observation& b) {
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) {
    EXPECT_EQ(a.events[k].kind, b.events[k].kind);
    EXPECT_EQ(a.events[k].time, b.events[k].time);
    EXPECT_EQ(a.events[k].particle, b.events[k].particle);
    EXPECT_EQ(a.events[k].value, b.events[k].value);
  }
}

TEST(StepResultMessage, HasTheBitsOfAnObservationWithoutRos) {
  TimedSimulation simulation({smallStomach(), ""}, 1, kEpoch, 1);
  Trainee trainee(smallStomach(), Skill::expert(), 1);
  trainee.add(InsufflateGoal{1});
  trainee.add(BiteGoal{{0.5, 0.3, 0, 0}});
  bool touched = false, gripped = false, closed = false;
  std::size_t events = 0;
  for (int k = 0; k < 1200 && !(touched && gripped && closed) && !HasFailure(); ++k) {
    const Observation wanted = observe(simulation.simulation()), seen = fromMessages(simulation);
    expectSame(seen, wanted);
    expectSameEvents(seen, wanted);
    touched = touched || seen.force.norm() > 0.1;
    gripped = gripped || seen.grips;
    closed = closed || seen.arm_closed;
    events += seen.events.size();
    StepInput input = trainee.next(seen);
    if (gripped) input.joints[NeedleDriver] = 18e-3;  // whatever it wants to do next
    simulation.setInput(input);
    simulation.step();
  }
  EXPECT_TRUE(touched && gripped && closed) << "the session shows too little";
  EXPECT_GT(events, 3u);
}

TEST(StepResultMessage, TheWallIsRoundedToSinglePrecision) {
  TimedSimulation simulation({smallStomach(), ""}, 1, kEpoch, 1);
  simulation.setInput(StepInput{});
  simulation.step();
  const std::vector<Eigen::Vector3d> wall = fromMessages(simulation).wall;
  int rounded = 0;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    EXPECT_NEAR(wall[i].x(), simulation.state().x[i], 1e-7);
    rounded += wall[i].x() != simulation.state().x[i] ? 1 : 0;
  }
  EXPECT_GT(rounded, static_cast<int>(wall.size()) / 2) << "a comparison of bits would find a wall that is not rounded";
}

TEST(StepResultMessage, AWallComesSixtyTimesASecond) {
  EXPECT_EQ(imageInterval(1. / 60), 1);
  EXPECT_EQ(imageInterval(0.02), 1);
  EXPECT_EQ(imageInterval(1e-3), 17);
  TimedSimulation simulation({smallStomach(), ""}, 1, kEpoch, 1);
  EXPECT_TRUE(makeStepResult(simulation, false).has_particles);
}

TEST(StepResultMessage, AnotherKindOfCloudIsRefused) {
  sensor_msgs::PointCloud2 cloud;
  cloud.width = cloud.height = 1;
  EXPECT_THROW(readWall(cloud), Error);
  for (const char* name : {"x", "y", "z"}) {
    cloud.fields.emplace_back();
    cloud.fields.back().name = name;
    cloud.fields.back().datatype = sensor_msgs::PointField::FLOAT32;
    cloud.fields.back().offset = static_cast<std::uint32_t>(4 * (cloud.fields.size() - 1));
  }
  cloud.point_step = 12;
  cloud.data.resize(11);
  EXPECT_THROW(readWall(cloud), Error);
  cloud.data.resize(12);
  EXPECT_EQ(readWall(cloud).size(), 1u);
  cloud.fields[1].datatype = sensor_msgs::PointField::FLOAT64;
  EXPECT_THROW(readWall(cloud), Error);
}

}  // namespace
}  // namespace vibe::sim::step_result_message_test
