// An emulated arm drives joints through the pure step, with delays both ways, and feels a wall.
#include "vibe_hardware/crtk/teleop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "gamepad/pads.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_hardware/emulator/emulated_arm.hpp"

namespace vibe::hardware::teleop_test {
namespace {

TeleopMapping mappingOf(const std::string& extra = "") {
  return parseTeleopMapping(
      "name: test\nhand: {away: -z, up: y}\njoints:\n"
      "  insertion: {along: x, scale: 1}\n  rotation: {about: x, scale: 2}\n"
      "  tip_up_down: {along: z, scale: 10 deg/cm}\n" +
          extra,
      "my_arm.yaml", toolLimits());
}

std::string errorOf(const std::string& text) {
  try {
    parseTeleopMapping(text, "my_arm.yaml", toolLimits());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A teleoperation in virtual time.
struct Session {
  TeleopMapping mapping = mappingOf();
  ToolLimits limits = toolLimits();
  TeleopState state = startTeleop(mapping, 0);
  TeleopInput input;
  TeleopOutput output;
  double time = 0;
  ArmSample arm;

  Session() { input.ready = true; }

  /// One millisecond in which the arm goes somewhere.
  void tick(const Eigen::Vector3d& way = Eigen::Vector3d::Zero(),
            const Eigen::Vector3d& turn = Eigen::Vector3d::Zero()) {
    time += 1e-3;
    arm.time = time;
    arm.position += way;
    if (turn.norm() > 0) arm.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * arm.orientation;
    input.sample = arm;
    output = step(mapping, limits, time, input, state);
    input.sample.reset();
  }
  void silence(double seconds) {
    for (const double end = time + seconds; time < end;) {
      time += 5e-3;
      output = step(mapping, limits, time, input, state);
    }
  }
};

TEST(Teleop, AClutchThatIsReversedFreesTheArmWhileItIsUp) {
  Session s;
  s.mapping = mappingOf("clutch: {topic: c, reversed: true}\n");
  s.tick();
  EXPECT_FALSE(s.output.engaged);
  s.input.clutch = true;
  s.tick();
  EXPECT_TRUE(s.output.engaged);
}

TEST(Teleop, MotionsOfTheHandMoveTheJoints) {
  Session s;
  s.input.joints = {0.05, 0.1, 0.2, 0.3, 0.001, 0.002, 0.003};
  s.tick();
  EXPECT_TRUE(s.output.engaged);
  EXPECT_EQ(s.output.joints, s.input.joints);
  for (int i = 0; i < 100; ++i) s.tick({0, 1e-4, -2e-4}, {0, 0, -1e-3});  // up, away, and clockwise for the person
  EXPECT_NEAR(s.output.joints[Insertion], 0.05 + 0.02, 1e-9);
  EXPECT_NEAR(s.output.joints[Rotation], 0.1 + 2 * 0.1, 1e-9);
  EXPECT_NEAR(s.output.joints[TipUpDown], 0.2 + 10 * M_PI / 180, 1e-9);
  EXPECT_EQ(s.output.joints[TipLeftRight], 0.3);  // nothing moves it
  EXPECT_EQ(s.output.joints[HelixAdvance], 0.001);
}

TEST(Teleop, JointsStayWithinTheirLimits) {
  Session s;
  for (int i = 0; i < 2000; ++i) s.tick({0, 0, -4e-4});
  EXPECT_EQ(s.output.joints[Insertion], s.limits[Insertion].upper);
}

TEST(Teleop, WithTheClutchTheHandComesBackAndTheScopeStays) {
  Session s;
  s.tick();
  for (int i = 0; i < 100; ++i) s.tick({0, 0, -1e-4});
  s.input.joints = s.output.joints;
  s.input.clutch = true;
  for (int i = 0; i < 100; ++i) s.tick({0, 0, 1e-4});
  EXPECT_FALSE(s.output.engaged);
  EXPECT_NEAR(s.output.joints[Insertion], 0.01, 1e-9);
  s.input.clutch = false;
  for (int i = 0; i < 100; ++i) s.tick({0, 0, -1e-4});
  EXPECT_NEAR(s.output.joints[Insertion], 0.02 - 1e-4, 2e-4);
}

TEST(Teleop, TheButtonForTheDeviceMovesItAndTheScopeStays) {
  Session s;
  s.mapping = mappingOf(
      "device:\n  button: {topic: button2}\n  joints:\n    helix_advance: {along: x, scale: 0.5}\n"
      "    helix_rotation: {about: x, scale: 4}\n");
  s.tick();
  for (int i = 0; i < 100; ++i) s.tick({0, 0, -1e-4});
  s.input.joints[HelixAdvance] = 0.002;  // another node has moved it
  s.input.device = true;
  s.tick();
  EXPECT_TRUE(s.output.on_device);
  for (int i = 0; i < 100; ++i) s.tick({0, 0, -4e-5}, {0, 0, -1e-3});
  EXPECT_NEAR(s.output.joints[Insertion], 0.01, 1e-9);
  EXPECT_EQ(s.output.joints[Rotation], 0);
  EXPECT_NEAR(s.output.joints[HelixAdvance], 0.002 + 0.5 * 0.004, 1e-9);
  EXPECT_NEAR(s.output.joints[HelixRotation], 4 * 0.1, 1e-9);
  s.input.device = false;
  s.tick();
  for (int i = 0; i < 100; ++i) s.tick({0, 0, 1e-4});
  EXPECT_FALSE(s.output.on_device);
  EXPECT_NEAR(s.output.joints[Insertion], 0.01 - 0.01, 1e-9);  // goes on from where it was sent, without a jump
  EXPECT_NEAR(s.output.joints[HelixRotation], 0.4, 1e-9);
}

TissueResponse wallAt(double time, double insertion, double effort, double stiffness) {
  TissueResponse tissue;
  tissue.time = time;
  tissue.joints[Insertion] = {insertion, effort, stiffness, 0, 0};
  return tissue;
}

TEST(Teleop, AForceGoesBackByVirtualWorkAndWithoutAJump) {
  Session s;
  s.mapping = mappingOf("arm: {torque_limit: 0.1 N*m}\n");
  s.tick();
  s.input.tissue = wallAt(s.time, 0, -1, 0);
  s.input.tissue->joints[Rotation].effort = 0.01;
  s.tick();
  EXPECT_LT(s.output.force.norm(), 0.1);
  double largest_change = 0, before = 0;
  for (int i = 0; i < 200; ++i) {
    s.input.tissue->time = s.time;
    s.tick();
    largest_change = std::max(largest_change, std::abs(s.output.force.norm() - before));
    before = s.output.force.norm();
  }
  EXPECT_LT(largest_change, 0.06);
  EXPECT_NEAR(s.output.force.z(), 1, 1e-3);  // the wall pushes back to the person
  EXPECT_NEAR(s.output.torque.z(), -2 * 0.01, 1e-5);
  s.mapping.force_frame = ForceFrame::Body;
  s.arm.orientation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX());
  s.state.last->orientation = s.arm.orientation;
  s.tick();
  EXPECT_NEAR(s.output.force.y(), 1, 1e-2);
}

TEST(Teleop, WithoutNewsOfTheTissueTheForceFades) {
  Session s;
  s.tick();
  for (int i = 0; i < 200; ++i) s.input.tissue = wallAt(s.time, 0, -1, 0), s.tick();
  EXPECT_NEAR(s.output.force.norm(), 1, 1e-2);
  for (int i = 0; i < 160; ++i) s.tick();
  EXPECT_LT(s.output.force.norm(), 1e-3);
}

TEST(Teleop, OnTheDeviceTheArmFeelsNothing) {
  Session s;
  s.mapping = mappingOf("device: {button: {topic: b}, joints: {helix_rotation: {about: x, scale: 4}}}\n");
  s.tick();
  for (int i = 0; i < 200; ++i) s.input.tissue = wallAt(s.time, 0, -1, 0), s.tick();
  EXPECT_NEAR(s.output.force.norm(), 1, 1e-2);
  s.input.device = true;
  for (int i = 0; i < 20; ++i) s.input.tissue = wallAt(s.time, 0, -1, 0), s.tick();
  EXPECT_EQ(s.output.force.norm(), 0);
  s.input.device = false;
  for (int i = 0; i < 200; ++i) s.input.tissue = wallAt(s.time, 0, -1, 0), s.tick();
  EXPECT_NEAR(s.output.force.norm(), 1, 1e-2);
}

TEST(Teleop, AnArmThatIsSilentJumpsOrIsNotReadyGetsNoForce) {
  const auto pressing = [] {
    Session s;
    s.tick();
    for (int i = 0; i < 200; ++i) s.input.tissue = wallAt(s.time, 0, -1, 0), s.tick();
    EXPECT_GT(s.output.force.norm(), 0.9);
    return s;
  };
  Session silent = pressing();
  silent.silence(0.15);
  EXPECT_EQ(silent.output.force.norm(), 0);
  EXPECT_FALSE(silent.output.engaged);
  silent.tick({0, 0, -0.2});  // it was elsewhere meanwhile
  EXPECT_TRUE(silent.output.engaged);
  EXPECT_EQ(silent.output.joints, silent.input.joints);

  Session jumping = pressing();
  jumping.tick({0, 0, -0.2});
  EXPECT_EQ(jumping.output.force.norm(), 0);
  EXPECT_NE(jumping.output.sentence.find("jumped"), std::string::npos);
  jumping.tick();
  EXPECT_LT(jumping.output.joints[Insertion], 1e-3);

  Session disabled = pressing();
  disabled.input.ready = false;
  disabled.tick();
  EXPECT_EQ(disabled.output.force.norm(), 0);
}

TEST(Teleop, AfterAHundredDropoutsTheForceComesBackWithinTwoSeconds) {
  for (const double gap : {0.15, 0.3}) {
    Session s;
    s.tick();
    const auto press = [&s](int ticks) {
      for (int i = 0; i < ticks; ++i) s.input.tissue = wallAt(s.time, 0, -1.5, 0), s.tick();
    };
    press(200);
    EXPECT_NEAR(s.output.force.norm(), 1.5, 1e-2);
    double withheld = 0;
    for (int i = 0; i < 100; ++i) {
      s.silence(gap);
      press(50);
      withheld = std::max(withheld, s.output.withheld);
    }
    EXPECT_GT(withheld, 0.3) << gap;  // which is said
    press(2000);
    EXPECT_NEAR(s.output.force.norm(), 1.5, 1e-2) << gap;
    EXPECT_EQ(s.output.withheld, 0) << gap;
  }
}

TEST(Teleop, AnArmThatMeasuresOnlyItsJointsDrivesAndFeels) {
  Session s;
  s.mapping = parseTeleopMapping(
      "name: test\njoints:\n  insertion: {slide: rail, scale: -2}\n  rotation: {turn: wrist, scale: 0.5}\n"
      "device: {button: {topic: b}, joints: {helix_rotation: {turn: wrist, scale: 3}}}\n",
      "my_arm.yaml", toolLimits());
  EXPECT_EQ(s.mapping.arm_joints, (std::vector<std::string>{"rail", "wrist"}));
  EXPECT_EQ(s.mapping.force_topic, "servo_jf");
  s.tick();
  const auto move = [&s](double rail, double wrist) {
    for (int i = 0; i < 100; ++i) s.arm.joints[0] += rail / 100, s.arm.joints[1] += wrist / 100, s.tick();
  };
  move(-0.01, 0.2);
  EXPECT_NEAR(s.output.joints[Insertion], 0.02, 1e-9);
  EXPECT_NEAR(s.output.joints[Rotation], 0.1, 1e-9);
  for (int i = 0; i < 200; ++i) s.input.tissue = wallAt(s.time, 0.02, -1, 0), s.tick();
  EXPECT_NEAR(s.output.efforts[0], 2, 1e-2);  // virtual work
  EXPECT_EQ(s.output.efforts[1], 0);
  s.input.device = true;
  s.tick();
  move(0, 0.1);
  EXPECT_NEAR(s.output.joints[HelixRotation], 0.3, 1e-9);
  EXPECT_NEAR(s.output.joints[Rotation], 0.1, 1e-9);
}

/// With a gripper whose 45 degrees are 18 mm of the needle arm, and a tool that is where it was sent.
struct GripperSession : Session {
  GripperSession() {
    mapping =
        mappingOf("gripper: {joint: needle_driver, closed: 0 deg, open: 45 deg, at_closed: 18 mm, at_open: 0 mm}\n");
    input.joints[NeedleDriver] = 0.009;
    input.gripper = 0;  // closed
    tick();
  }
  double jaw() const { return output.joints[NeedleDriver]; }
  void to(double degrees, double seconds = 0.5) {
    const double begin = *input.gripper, end = degrees * M_PI / 180;
    for (int i = 1; i <= 1e3 * seconds; ++i) input.gripper = begin + (end - begin) * i / (1e3 * seconds), tick();
  }
};

TEST(Teleop, TheGripperTakesItsJointUpWhereItIsAndReachesItsWholeWayAgain) {
  GripperSession s;
  for (int i = 0; i < 2000; ++i) s.tick();
  EXPECT_EQ(s.jaw(), 0.009);  // nobody has moved the gripper
  s.to(10);
  EXPECT_NEAR(s.jaw(), 0.009 - 0.004, 1e-9);
  s.to(45);
  EXPECT_NEAR(s.jaw(), 0, 1e-9);
  s.to(0);
  EXPECT_NEAR(s.jaw(), 0.018, 1e-9);
  s.to(20);
  s.input.clutch = true;
  s.input.joints = s.output.joints;
  s.to(23);
  s.input.clutch = false;
  s.tick();
  EXPECT_NEAR(s.jaw(), 0.018 - 0.008, 1e-9);
  s.to(45);
  EXPECT_GT(s.jaw(), 0.001);
  s.to(45);
  EXPECT_NEAR(s.jaw(), 0, 1e-9);  // it was 1.2 mm behind, and comes along at the end
}

TEST(Teleop, AJumpOfTheGripperMovesNothing) {
  GripperSession s;
  s.to(30);
  const double before = s.jaw();
  s.input.gripper = 0;
  for (int i = 0; i < 2000; ++i) s.tick();
  EXPECT_EQ(s.jaw(), before);
}

TEST(Teleop, AButtonThatWasPressedBeforeCountsWhenItIsPressedAnew) {
  Session s;
  s.input.buttons[HelixGrab] = 1;
  s.input.ready = false;
  s.tick();
  s.input.ready = true;
  s.tick();
  EXPECT_EQ(s.output.buttons[HelixGrab], 0);
  s.input.buttons[HelixGrab] = 0;
  s.tick();
  s.input.buttons[HelixGrab] = 1;
  s.input.clutch = true;  // the helix holds on
  s.tick();
  EXPECT_EQ(s.output.buttons[HelixGrab], 1);
  s.silence(0.15);
  EXPECT_EQ(s.output.buttons[HelixGrab], 0);
  s.tick();
  EXPECT_EQ(s.output.buttons[HelixGrab], 0);
}

/// An arm that moves the suturing device while the pedal that changes over is up.
struct PedalSession : Session {
  PedalSession() {
    mapping = mappingOf(
        "device: {button: {topic: p, reversed: true}, joints: {helix_advance: {along: x, scale: 1}}}\n"
        "gripper: {button: t_tag, closed: 0 deg, open: 40 deg}\n"
        "buttons:\n  helix_grab: {topic: a, mode: toggle, while: device}\n  insufflate: {topic: a, while: scope}\n"
        "  cinch: {topic: b, while: device}\n");
    tick();
    input.gripper = 0;  // closed before it is known
    tick();
  }
  int press(std::initializer_list<Button> buttons) {
    input.buttons = {};
    for (const Button button : buttons) input.buttons[button] = 1;
    tick();
    return output.buttons[HelixGrab] + 2 * output.buttons[Insufflate] + 4 * output.buttons[Cinch];
  }
};

TEST(Teleop, APedalThatIsReversedMovesTheScopeWhileItIsDown) {
  PedalSession s;
  EXPECT_TRUE(s.output.on_device);
  s.input.device = true;
  s.tick();
  EXPECT_FALSE(s.output.on_device);
  EXPECT_TRUE(s.output.moves_scope);
  EXPECT_FALSE(s.output.moves_device);  // its gripper is a button
}

TEST(Teleop, APedalDoesWhatItIsForWhileTheArmMovesThatAndKeepsItUntilItComesUp) {
  PedalSession s;
  EXPECT_EQ(s.press({HelixGrab, Insufflate}), 1);  // the same pedal
  EXPECT_EQ(s.press({}), 1);                       // it switches
  EXPECT_EQ(s.press({Cinch}), 5);
  s.input.device = true;
  EXPECT_EQ(s.press({Cinch}), 5);  // a cinch that is held does not crimp because the foot changes over
  EXPECT_EQ(s.press({}), 1);
  EXPECT_EQ(s.press({Cinch}), 1);
  EXPECT_EQ(s.press({HelixGrab, Insufflate}), 3);
  s.silence(0.15);
  EXPECT_EQ(s.output.buttons[Insufflate], 0);
  EXPECT_EQ(s.output.buttons[HelixGrab], 1);  // nobody has pressed again
  s.input.ready = false;
  EXPECT_EQ(s.press({}), 0);
}

TEST(Teleop, AGripperPressesItsButtonWhenItClosesAnew) {
  PedalSession s;
  const auto pressedAt = [&s](double degrees) {
    s.input.gripper = degrees * M_PI / 180;
    s.tick();
    return s.output.buttons[TTag];
  };
  for (const auto& [degrees, pressed] : {std::pair{5, 0}, {15, 0}, {25, 0}, {15, 0}, {5, 1}, {15, 1}, {25, 0}})
    EXPECT_EQ(pressedAt(degrees), pressed) << degrees;
}

TEST(Teleop, AnArmForTheDeviceAloneMovesNothingElse) {
  Session s;
  s.mapping = parseTeleopMapping(
      "name: a\nhand: {away: -z, up: y}\ndevice: {joints: {helix_advance: {along: x, scale: 1}}}\n", "a", toolLimits());
  s.tick();
  for (int i = 0; i < 100; ++i) s.tick({0, 0, -1e-4});
  EXPECT_NEAR(s.output.joints[HelixAdvance], 0.01, 1e-9);
  EXPECT_TRUE(s.output.moves_device);
  EXPECT_FALSE(s.output.moves_scope);
  EXPECT_FALSE(pressesButtons(s.mapping));
}

TEST(Teleop, AnArmAtRestFollowsAToolThatSomebodyElseMoves) {
  Session s;
  s.tick();
  for (int i = 0; i < 28; ++i) s.input.joints[Insertion] += 1e-3, s.tick(), s.tick();
  for (int i = 0; i < 300; ++i) s.tick();
  EXPECT_NEAR(s.output.joints[Insertion], 0.028, 0.5e-3);
  for (int i = 0; i < 100; ++i) s.tick({0, 0, -1e-4});
  EXPECT_NEAR(s.output.joints[Insertion], 0.038, 0.5e-3);  // and goes on from there
}

TEST(Teleop, AnArmThatIsNotObeyedGivesWayWhenItRests) {
  Session s;
  s.input.live = true;
  s.tick();
  for (int i = 0; i < 900; ++i) s.tick({0, 0, -3e-5});
  EXPECT_NEAR(s.output.joints[Insertion], 0.027, 1e-9);  // as long as it moves, the tool may only be late
  for (int i = 0; i < 1200; ++i) s.tick();
  EXPECT_EQ(s.output.joints[Insertion], 0);
}

TEST(Teleop, AToolThatIsSlowOrLateIsNotTakenForMovedByOthers) {
  Session s;
  s.input.live = true;
  std::deque<double> news(80, 0.0);  // [ms]
  double tool = 0;
  s.tick();
  for (int i = 0; i < 4000; ++i) {
    const double speed = i < 3000 ? 0.4 * std::cos(i * 2e-3 * M_PI) : 0;  // [m/s]; the tool makes 0.15
    tool += std::clamp(s.output.joints[Insertion] - tool, -0.15e-3, 0.15e-3);
    news.push_back(tool), news.pop_front();
    s.input.joints[Insertion] = news.front();
    s.tick({0, 0, -1e-3 * (speed + 0.05)});
  }
  EXPECT_NEAR(s.output.joints[Insertion], 0.2, 1e-3);
}

TEST(Teleop, EqualInputsGiveEqualOutputs) {
  Session a, b;
  for (int i = 0; i < 300; ++i)
    for (Session* s : {&a, &b}) s->input.tissue = wallAt(s->time, 0, -1, 200), s->tick({0, 1e-5, -1e-4});
  EXPECT_EQ(a.output.force, b.output.force);
  EXPECT_EQ(a.output.joints, b.output.joints);
}

/// A hand presses an arm into a wall of this stiffness at 1 cm, whose news come every 16 ms; all ways have delays.
/// @return energy that the arm has given to the hand at most, within any interval [J]
double pressWall(double stiffness, double delay, bool controlled) {
  Session s;
  if (!controlled)
    for (HandJoint& joint : s.mapping.joints) joint.port.capacity = 1e9, joint.port.resolution = 0;
  s.state = startTeleop(s.mapping, 0);
  EmulatedArmConfig config;
  config.hand_stiffness = 50, config.hand_damping = 1;
  EmulatedArmState arm;
  std::deque<ArmSample> measured;
  std::deque<Eigen::Vector3d> forces;
  double lowest = 0, most = 0, news = -1;
  const auto late = static_cast<std::size_t>(delay / 1e-3);
  for (int i = 0; i < 5000; ++i) {
    HandIntent intent;
    intent.position.z() = -0.02;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (forces.size() > late) force = forces.front(), forces.pop_front();
    for (int k = 0; k < 10; ++k) stepArm(config, 1e-4, force, Eigen::Vector3d::Zero(), intent, arm);
    lowest = std::min(lowest, arm.given);
    most = std::max(most, arm.given - lowest);
    s.time += 1e-3;
    measured.push_back({s.time, arm.position, orientationOf(arm)});
    if (measured.size() > late) s.input.sample = measured.front(), measured.pop_front();
    if (s.time - news > 0.016) {
      news = s.time;
      const double depth = s.state.joints[Insertion] - 0.01;
      s.input.tissue.reset();
      if (depth > 0) s.input.tissue = wallAt(s.time, s.state.joints[Insertion], -stiffness * depth, stiffness);
    }
    s.output = step(s.mapping, s.limits, s.time, s.input, s.state);
    s.input.sample.reset();
    forces.push_back(s.output.force);
  }
  return most;
}

TEST(Teleop, AWallGivesNoMoreThanTheCapacityWhateverItsStiffness) {
  int exceeded_without = 0;
  for (const double stiffness : {100., 500., 2000.})
    for (const double delay : {0.0, 0.005, 0.01}) {
      EXPECT_LE(pressWall(stiffness, delay, true), 0.05) << stiffness << " N/m, " << delay << " s";
      exceeded_without += pressWall(stiffness, delay, false) > 0.05 ? 1 : 0;
    }
  EXPECT_GT(exceeded_without, 1);  // negative control
}

TEST(TeleopMapping, ShippedMappingsMoveEveryJointOfTheScope) {
  for (const std::string name : {"touch", "dvrk_mtm", "dvrk_left"}) {
    const TeleopMapping mapping = loadTeleopMapping("../config/arms/" + name + ".yaml", toolLimits());
    for (int j = 0; j < kScopeJointCount; ++j)
      EXPECT_GE(mapping.joints[static_cast<std::size_t>(j)].coordinate, 0) << name;
    EXPECT_NEAR(mapping.hand.determinant(), 1, 1e-12) << name;
    EXPECT_FALSE(mapping.clutch.topic.empty()) << name;
  }
}

TEST(TeleopMapping, MistakesAreNamedWithPlaceAndRemedy) {
  const std::string head = "name: a\nhand: {away: x, up: z}\n";
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"name: a\nhand: {away: x, up: -x}\njoints:\n  insertion: {along: x, scale: 1}\n", "same axis"},
           {head + "joints: {}\n", "moves nothing"},
           {"name: a\njoints:\n  insertion: {along: x, scale: 1}\n", "lacks the key 'hand'"},
           {head + "joints:\n  insertion: {slide: rail, scale: 1}\n", "leave it out"},
           {"name: a\njoints:\n  insertion: {slide: a, scale: 1}\n  rotation: {about: x, scale: 1}\n", "by its joints"},
           {"name: a\njoints:\n  rotation: {about: x, scale: 1}\n  insertion: {slide: a, scale: 1}\n", "by its joints"},
           {"name: a\njoints:\n  insertion: {slide: a, scale: 1}\n  rotation: {slide: a, scale: 1 rad/m}\n", "already"},
           {"name: a\njoints:\n  insertion: {slide: a, scale: 1}\nforces: {axes: body}\n", "mapped by its joints"},
           {head + "joints:\n  insertion: {along: x}\n", "lacks the key 'scale'"},
           {head + "joints:\n  insertion: {along: x, about: y, scale: 1}\n", "exactly one"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\n  rotation: {along: x, scale: 1 rad/m}\n", "already"},
           {head + "joints:\n  insertion: {along: x, scale: 0}\n", "is 0"},
           {head + "joints:\n  insertion: {along: x, scale: 2 rad/m}\n", "insertion.scale"},
           {head + "joints:\n  insertion: {along: x, scale: .nan}\n", "insertion.scale"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\narm: {delay: -1 ms}\n", "arm.delay"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\ngripper: {joint: needle_driver, closed: 1, open: 1, "
                   "at_closed: 0, at_open: 0}\n",
            "differ"},
           {head + "arm: {delay: 1 ms}\n", "lacks the key 'joints'"},
           {head +
                "joints:\n  insertion: {along: x, scale: 1}\ndevice: {joints: {helix_advance: {along: x, scale: 1}}}\n",
            "button that changes over"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\nclutch: {topic: b}\nbuttons: {cinch: {topic: b}}\n",
            "control of clutch already"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\nbuttons: {cinch: {topic: b, while: scope}}\n",
            "changes over"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\ngripper: {closed: 0, open: 1}\n", "either joint"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\ngripper: {button: cinch, closed: 0, open: 1}\n"
                   "buttons: {cinch: {topic: b}}\n",
            "pressed by the gripper"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\ndevice: {button: {topic: b}, joints: {}}\n",
            "joint of the suturing device"},
           {head + "joints:\n  insertion: {along: x, scale: 1}\ngripper: {joint: needle_driver, closed: 0, open: 1, "
                   "at_closed: 0, at_open: 0}\ndevice: {button: {topic: b}, joints: {needle_driver: {along: x, scale: "
                   "1}}}\n",
            "by the gripper already"}}) {
    const std::string error = errorOf(text);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find("my_arm.yaml:"), 0U) << error;
  }
}

}  // namespace
}  // namespace vibe::hardware::teleop_test
