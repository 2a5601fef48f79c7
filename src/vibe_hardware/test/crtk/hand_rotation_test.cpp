// How the rotation of a hand moves joints: twist and swing on the group, without drift, and with torques that do the
// same work.
#include "vibe_hardware/crtk/hand_rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gamepad/pads.hpp"
#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware::hand_rotation_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

struct Random {
  std::mt19937 engine{1};
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  Vector3d vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  Quaterniond orientation() { return Quaterniond(in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1)).normalized(); }
};

Quaterniond turnOf(const Vector3d& vector) {
  return vector.norm() < 1e-15 ? Quaterniond::Identity()
                               : Quaterniond(Eigen::AngleAxisd(vector.norm(), vector.normalized()));
}

/// An arm whose rotation moves three joints, one to one.
struct Session {
  TeleopMapping mapping = parseTeleopMapping(
      "name: test\nhand: {away: -z, up: y}\narm: {torque_limit: 0.1 N*m}\njoints:\n  rotation: {about: x, scale: 1}\n"
      "  tip_up_down: {about: y, scale: 1}\n  tip_left_right: {about: z, scale: 1}\n",
      "my_arm.yaml", toolLimits());
  TeleopState state = startTeleop(mapping, 0);
  TeleopInput input;
  TeleopOutput output;
  double time = 0;

  Session() {
    input.ready = true;
    for (JointLimits& joint : limits) joint.lower = -100, joint.upper = 100;
  }
  void to(const Quaterniond& orientation) {
    time += 5e-3;
    input.sample = ArmSample{time, Vector3d::Zero(), orientation, {}};
    output = step(mapping, limits, time, input, state);
  }
  double rotation() const { return output.joints[Rotation]; }

  ToolLimits limits = toolLimits();
};

TEST(HandRotation, ATwistCountsWholeAtEveryTilt) {
  Random random;
  for (int k = 0; k < 200; ++k) {
    const Quaterniond reference = random.orientation();
    const Vector3d stylus = random.vector(1).normalized(), side = stylus.unitOrthogonal();
    const Quaterniond tilt = turnOf(random.in(0, 2.8) * side);
    const double twist = random.in(-20, 20), further = random.in(-3, 3);
    const Matrix3d hand = random.orientation().toRotationMatrix();
    const auto at = [&](double angle) {
      return rotationSince(reference, reference * tilt * turnOf(angle * stylus), hand, k % 3, stylus, angle);
    };
    const HandRotation before = at(twist), after = at(twist + further);
    EXPECT_NEAR(before.angles[k % 3], twist, 1e-9);
    EXPECT_NEAR(after.angles[k % 3] - before.angles[k % 3], further, 1e-9);
    for (const int i : {(k + 1) % 3, (k + 2) % 3}) EXPECT_NEAR(after.angles[i], before.angles[i], 1e-9);
  }
}

TEST(HandRotation, ATiltedStylusTurnsTheScopeByItsOwnAngle) {
  for (const double tilt : {0., 20., 45., 70., -45., 160.})
    for (const double away_first : {0., 1.}) {  // tilted before or after the arm engages
      Session s;
      const Quaterniond tilted = turnOf(tilt * kDegree * Vector3d::UnitX());
      for (int i = 0; i <= 100; ++i) s.to(turnOf(away_first * i / 100 * tilt * kDegree * Vector3d::UnitX()));
      if (away_first == 0) s = Session(), s.to(tilted);
      const double before = s.rotation();
      for (int i = 0; i <= 200; ++i) s.to(tilted * turnOf(-i * 2.5 * kDegree * Vector3d::UnitZ()));
      EXPECT_NEAR((s.rotation() - before) / kDegree, 500, 1e-6) << tilt;
    }
}

/// What the integral of the angular velocity about a fixed axis would leave.
double integral(const std::vector<Quaterniond>& path, const Vector3d& axis) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::AngleAxisd turn(path[i] * path[i - 1].conjugate());
    sum += turn.angle() * turn.axis().dot(axis);
  }
  return sum;
}

double left(const std::vector<Quaterniond>& path) {
  Session s;
  for (const Quaterniond& orientation : path) s.to(orientation);
  const auto& joints = s.output.joints;
  return std::max({std::abs(joints[Rotation]), std::abs(joints[TipUpDown]), std::abs(joints[TipLeftRight])});
}

TEST(HandRotation, ClosedPathsLeaveNothing) {
  for (const double half : {10., 20., 30., 45., 80.}) {
    std::vector<Quaterniond> path;
    for (int i = 0; i <= 3000; ++i) {
      const Vector3d round = -i * 2 * M_PI / 1000 * Vector3d::UnitZ();
      path.push_back(turnOf(round) * turnOf(half * kDegree * Vector3d::UnitX()) * turnOf(-round));
    }
    EXPECT_LT(left(path), 1e-9) << half;
    EXPECT_GT(std::abs(integral(path, -Vector3d::UnitZ())), 10 * kDegree);  // negative control
  }
  Random random;
  for (int k = 0; k < 50; ++k) {
    const Quaterniond begin = random.orientation();
    const Vector3d a = random.vector(0.8), b = random.vector(0.5), c = random.vector(0.5);
    std::vector<Quaterniond> path;
    for (int i = 0; i <= 1000; ++i) {
      const double u = 2 * M_PI * i / 1000;
      path.push_back(begin * turnOf(a * std::sin(u) + b * std::sin(2 * u) + c * (1 - std::cos(u))));
    }
    EXPECT_LT(left(path), 1e-9) << k;
  }
}

TEST(HandRotation, HowTheBaseIsTurnedChangesNothing) {
  Random random;
  for (int k = 0; k < 20; ++k) {
    Session a, b;
    const Quaterniond base = random.orientation();
    b.mapping.hand = base * a.mapping.hand;
    Quaterniond orientation = random.orientation();
    for (int i = 0; i < 200; ++i) {
      orientation = turnOf(random.vector(0.02)) * orientation;
      a.to(orientation), b.to(base * orientation);
    }
    for (const int joint : {Rotation, TipUpDown, TipLeftRight})
      EXPECT_NEAR(a.output.joints[static_cast<std::size_t>(joint)], b.output.joints[static_cast<std::size_t>(joint)],
                  1e-9);
  }
}

TEST(HandRotation, TheTorqueDoesTheWorkOfTheForcesOnTheAngles) {
  Random random;
  double largest = 0;
  for (int k = 0; k < 300; ++k) {
    Session s;
    const Quaterniond begin = random.orientation();
    const Vector3d swing = random.vector(1.2), spin = random.vector(1);
    for (int i = 0; i <= 50; ++i) s.to(turnOf(i / 50. * swing) * begin);
    s.input.tissue = TissueResponse{s.time, {}};
    for (const int joint : {Rotation, TipUpDown, TipLeftRight})
      s.input.tissue->joints[static_cast<std::size_t>(joint)].effort = random.in(-0.01, 0.01);
    for (int i = 0; i < 20; ++i) s.input.tissue->time = s.time, s.to(turnOf(swing) * begin);
    const auto hand_at = [&s, &swing, &begin](const Vector3d& turn) {
      Session moved = s;
      moved.to(turnOf(turn) * turnOf(swing) * begin);
      return moved.state.hand;
    };
    constexpr double kSmall = 1e-5;
    const auto ahead = hand_at(kSmall * spin), behind = hand_at(-kSmall * spin);
    double power = 0;
    for (std::size_t i = HandRoll; i < kHandCoordinates; ++i)
      power += s.output.efforts[i] * (ahead[i] - behind[i]) / (2 * kSmall);
    EXPECT_NEAR(power, s.output.torque.dot(spin), 1e-9);
    largest = std::max(largest, std::abs(power));
  }
  EXPECT_GT(largest, 5e-3);
}

TEST(HandRotation, BeyondTheSingularityTheScopeDoesNotJump) {
  Session s;
  double largest = 0, before = 0;
  for (int i = 0; i < 2000; ++i) {  // the stylus somersaults, almost through the opposite of where it began
    s.to(turnOf(i * 0.01 * Vector3d::UnitX()) * turnOf(0.1 * std::sin(i * 0.005) * Vector3d::UnitY()));
    largest = std::max(largest, std::abs(s.rotation() - before));
    before = s.rotation();
  }
  EXPECT_LT(largest, 0.01 / std::cos(85 * kDegree));  // at a swing of 170 degrees
}

TEST(HandRotation, TheMappingNamesTheAxisOfTheStylus) {
  const auto mapping = [](const std::string& hand, const std::string& joints) {
    return parseTeleopMapping("name: a\nhand: {away: -z, up: y" + hand + "}\njoints: {" + joints + "}\n", "a.yaml",
                              toolLimits());
  };
  EXPECT_EQ(mapping("", "rotation: {about: x, scale: 1}").stylus, Vector3d(0, 0, -1));
  EXPECT_EQ(mapping(", stylus: x", "rotation: {about: x, scale: 1}").stylus, Vector3d(1, 0, 0));
  const TeleopMapping knob = mapping("", "rotation: {about: z, scale: 1}");
  EXPECT_EQ(knob.twist, 2);
  EXPECT_EQ(knob.stylus, Vector3d(0, 1, 0));
}

}  // namespace
}  // namespace vibe::hardware::hand_rotation_test
