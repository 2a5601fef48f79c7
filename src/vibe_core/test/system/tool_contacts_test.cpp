// What a step says of the contacts of the tool: they are the force on it, part by part, and lie where the wall is.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::tool_contacts_test {
namespace {

using test::scopeAt;
using test::World;

constexpr double kRadius = 0.06, kFriction = 0.2;

/// A ball with gas and walls that may meet, and a scope with a helix above it.
Scene ballScene(const std::string& tissue = "shell") {
  Scene scene;
  scene.tissue.model = tissue;
  scene.tissue.self_contact = tissue == "shell";
  scene.foundation = FoundationScene{};
  scene.gas = GasScene{};
  scene.gas->initial_pressure = 800;
  scene.scope = test::scopeFromAbove(kRadius);
  scene.scope->friction = kFriction;
  scene.scope->compliance.reset();
  scene.helix = test::wideHelix();
  scene.suture = SutureScene{};
  return scene;
}

World ballWorld(const Scene& scene = ballScene()) {
  return test::scopeWorld(scene, test::openBall(kRadius, 3, 2.3e-3));
}

Eigen::Isometry3d tipOf(const Model& model, const State& state) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  return model.tool_base * poses[model.tip_link];
}

// How far the contacts are from the published wrench, in force and, with implicit steps, torque about the tip, over the
// force and over the force times a radius.
double imbalance(const Model& model, const State& state, const std::vector<ToolContact>& contacts) {
  const Eigen::Isometry3d tip = tipOf(model, state);
  Eigen::Vector3d force = -tip.linear() * state.tool_force, torque = -tip.linear() * state.tool_torque;
  for (const ToolContact& contact : contacts) {
    force += contact.force;
    torque += (contact.point - tip.translation()).cross(contact.force);
  }
  const double scale = state.tool_force.norm();
  return std::max(force.norm() / scale, model.solver->usesSubsteps() ? 0 : torque.norm() / (scale * kRadius));
}

Eigen::Vector3d placeOf(const SurfacePoint& point, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < point.count; ++k) {
    const int i = point.node[k];
    sum += point.weight[k] * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
  }
  return sum;
}

void checkPlace(const Model& model, const State& state, const ToolContact& contact) {
  const SurfacePoint& point = contact.surface;
  ASSERT_GT(point.count, 0);
  EXPECT_LT((placeOf(point, state) - contact.point).norm(), 1e-9);
  ASSERT_GE(contact.triangle, 0);
  const auto& nodes = model.organ.surface.triangles[contact.triangle];
  for (int k = 0; k < point.count; ++k) EXPECT_TRUE(std::count(nodes.begin(), nodes.end(), point.node[k]) == 1);
  const auto heaviest = std::max_element(point.weight.begin(), point.weight.begin() + point.count);
  EXPECT_EQ(contact.region, model.organ.region[point.node[heaviest - point.weight.begin()]]);
}

void checkContact(const Model& model, const State& state, const ToolContact& contact) {
  checkPlace(model, state, contact);
  EXPECT_NEAR(contact.normal.norm(), 1, 1e-9);
  EXPECT_EQ(contact.link, model.tool->shapes()[contact.shape].link);
  EXPECT_GE(contact.normalForce(), 0);
  if (model.solver->usesSubsteps()) return;  // a mean over sub-steps, the normal of the last
  EXPECT_LE(contact.tangentialForce().norm(), 1.01 * model.scene.scope->friction * contact.normalForce() + 1e-9);
  EXPECT_LT(std::abs(contact.gap), model.particle_radius) << "less than half a wall, also where the tool is fast";
}

/// What a run has met.
struct Seen {
  int steps = 0, contacts = 0, grips = 0;
};

void checkStep(const Model& model, const State& state, const StepReport& report, Seen& seen) {
  if (state.tool_force.norm() == 0) {
    EXPECT_TRUE(report.contacts.empty());
    return;
  }
  ++seen.steps;
  ASSERT_LT(imbalance(model, state, report.contacts), 1e-6);
  Eigen::Vector3d grip = Eigen::Vector3d::Zero();
  int count = 0;
  for (const ToolContact& contact : report.contacts)
    if (contact.kind == ToolContact::Kind::Grip) {
      grip += contact.force;
      ++seen.grips;
      EXPECT_EQ(contact.link, model.grip_link);
    } else {
      ++count;
      checkContact(model, state, contact);
    }
  seen.contacts += count;
  EXPECT_NEAR(grip.norm(), state.grip_force, 1e-9);
  if (!model.solver->usesSubsteps()) {
    EXPECT_EQ(count, state.contact_count);
  }
}

Seen checkRun(World& world, double seconds, const std::function<StepInput(double)>& input) {
  Seen seen;
  const long steps = std::lround(seconds / world.model->scene.step_period);
  for (long k = 0; k < steps && !::testing::Test::HasFatalFailure(); ++k) {
    world.step(input(static_cast<double>(k) * world.model->scene.step_period));
    checkStep(*world.model, world.state, world.workspace->report(), seen);
  }
  return seen;
}

/// Presses, slides, takes hold and pulls.
StepInput sessionAt(double time) {
  StepInput input = scopeAt(time < 2 ? 0.14 : 0.1, time < 2 ? 0 : 0.028, time > 4);
  if (time > 1 && time < 2) input.joints[TipUpDown] = 0.3;
  if (time > 4.5) input.joints[Insertion] = 0.08;
  return input;
}

TEST(ToolContacts, AreTheForceOnTheTool) {
  World world = ballWorld();
  const Seen seen = checkRun(world, 6, sessionAt);
  EXPECT_GT(seen.steps, 150);
  EXPECT_GT(seen.contacts, 300);
  EXPECT_GT(seen.grips, 100);
  ASSERT_FALSE(world.state.grip.empty());
}

TEST(ToolContacts, AreTheForceOnAToolThatGivesWay) {
  Scene scene = ballScene();
  scene.scope->compliance = ScopeComplianceScene{};
  World world = ballWorld(scene);
  const Seen seen = checkRun(world, 6, sessionAt);
  EXPECT_GT(seen.contacts, 100);
  EXPECT_GT(seen.grips, 100);
  EXPECT_NE(world.state.tool_displacement[Insertion], 0);
}

TEST(ToolContacts, AreTheForceOnTheToolWithShapeMatching) {
  World world = ballWorld(ballScene("shape_matching"));
  const Seen seen = checkRun(world, 6, sessionAt);
  EXPECT_GT(seen.contacts, 100);
  EXPECT_GT(seen.grips, 10);
}

TEST(ToolContacts, AreTheForceOnTheToolInTheDefaultScene) {
  Simulation simulation(loadModel("package://vibe_core/scenes/stomach.yaml"));
  Seen seen;
  simulation.run(
      240, [](double time) { return scopeAt(0.3 * std::min(1.0, time), 0); },
      [&](const Simulation& s) { checkStep(s.model(), s.state(), s.report(), seen); });
  EXPECT_GT(seen.contacts, 100);
}

TEST(ToolContacts, ControlAContactTooFewOrTurnedIsFound) {
  World world = ballWorld();
  world.run(2, scopeAt(0.14));
  std::vector<ToolContact> contacts = world.workspace->report().contacts;
  ASSERT_GT(contacts.size(), 2U);
  EXPECT_LT(imbalance(*world.model, world.state, contacts), 1e-6);
  const ToolContact last = contacts.back();
  contacts.pop_back();
  EXPECT_GT(imbalance(*world.model, world.state, contacts), 1e-3);
  contacts.push_back(last);
  contacts.back().force *= -1;
  EXPECT_GT(imbalance(*world.model, world.state, contacts), 1e-3);
}

/// A thread through the wall on both sides of the bottom, 45 mm apart at rest.
void sew(World& world) {
  const State& state = world.state;
  const auto& triangles = world.model->organ.surface.triangles;
  const SurfaceView wall{triangles, state.x, state.y, state.z};
  const auto centre = [&](int t) {
    const auto& [a, b, c] = triangles[static_cast<std::size_t>(t)];
    return Eigen::Vector3d((world.position(a) + world.position(b) + world.position(c)) / 3);
  };
  Suture suture;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d wanted = kRadius * Eigen::Vector3d(side * std::sin(0.38), 0, -std::cos(0.38));
    int nearest = 0;
    for (int t = 1; t < static_cast<int>(triangles.size()); ++t)
      if ((centre(t) - wanted).norm() < (centre(nearest) - wanted).norm()) nearest = t;
    suture.bites.push_back(
        biteAround(*world.model, wall, nearest, centre(nearest), world.model->scene.suture->bite_radius));
    suture.bites.back().depth = suture.bites.back().thickness;
  }
  suture.length = {0.045};
  suture.tension = {0};
  world.state.procedure.sutures.push_back(suture);
  world.state.procedure.needle_on_arm = false;
}

TEST(ToolContacts, OfACinchedWallWithItsThreadsAndItself) {
  World world = ballWorld();
  sew(world);
  EXPECT_TRUE(threadContacts(world.state).empty()) << "it does not pull yet";
  StepInput input = scopeAt(0.1);
  input.buttons[TTag] = 1;
  world.step(input);
  input.buttons[TTag] = 0;
  input.buttons[Cinch] = 1;
  const Seen seen = checkRun(world, 6, [&](double time) {
    input.joints[Insertion] = time < 4 ? 0.05 : 0.11;  // onto the fold
    return input;
  });
  EXPECT_GT(seen.contacts, 50);

  const std::vector<ThreadContact> threads = threadContacts(world.state);
  ASSERT_EQ(threads.size(), 2U);
  const double tension = world.state.procedure.sutures[0].tension[0];
  EXPECT_GT(tension, 0.2);
  EXPECT_NEAR(threads[0].force.norm(), tension, 1e-9);
  EXPECT_GT(threads[0].force.dot(threads[1].point - threads[0].point), 0) << "it draws the bites together";
  EXPECT_LT((threads[0].force + threads[1].force).norm(), 1e-12);

  WallContacts walls(*world.model);
  const std::vector<WallContact>& found = walls.find(world.state);
  ASSERT_FALSE(found.empty());
  double most = 0;
  for (const WallContact& contact : found) {
    Eigen::Vector3d apart = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (contact.node[k] >= 0) apart += contact.weight[k] * world.position(contact.node[k]);
    EXPECT_LT((apart - contact.distance * contact.normal).norm(), 1e-9);
    EXPECT_GE(contact.force, 0);
    most = std::max(most, contact.force);
  }
  EXPECT_GT(most, 1e-4);
}

// A wider press than friction is computed for: the contacts beyond slide, and answer along their normals only.
class Directions : public ConstraintBlock {
 public:
  /// @param most  touches of a step by the number of their directions, at most
  explicit Directions(std::array<int, 4>& most) : most_(most) {}
  Activity prepare(const StepContext&, BodyLoads&) override { return Activity::Sleep; }
  double store(const StepContext&, const BodyLoads&, std::vector<ToolTouch>& touches) override {
    std::array<int, 4> count{};
    for (const ToolTouch& touch : touches) {
      const auto directions = static_cast<std::size_t>(touch.direction_count);
      most_[directions] = std::max(most_[directions], ++count[directions]);
      const bool drags = touch.tangentialForce().norm() > 0;
      EXPECT_TRUE(touch.direction_count == 1 || drags) << "nothing holds it along the wall";
    }
    return 0;
  }

 private:
  std::array<int, 4>& most_;
};

TEST(ToolContacts, BeyondThoseWithFrictionSlide) {
  std::array<int, 4> most{};
  registerConstraint("directions", [&most](const Model&) { return std::make_unique<Directions>(most); });
  Scene scene = ballScene();
  scene.gas.reset();
  scene.suture.reset();
  scene.scope = test::scopeFromAbove(kRadius / 2);
  scene.scope->friction = 2;  // whatever has friction sticks
  World world = test::scopeWorld(scene, test::openBall(kRadius / 2, 4, 2.3e-3));
  unregisterConstraint("directions");
  world.run(2, scopeAt(0.09));
  ASSERT_GT(world.workspace->report().limited, 0);
  EXPECT_GT(most[3], 5);
  EXPECT_GT(most[1], 0) << "negative control: none of those beyond bears a force";
}

}  // namespace
}  // namespace vibe::tool_contacts_test
