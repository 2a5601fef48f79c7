// Messages <-> library, apart from those that have a test of their own.
#include "conversions/conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "conversions/input_message.hpp"
#include "conversions/procedure_message.hpp"
#include "conversions/session_message.hpp"
#include "conversions/tissue_message.hpp"
#include "conversions/tool_message.hpp"
#include "sentences.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim::conversions_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

sensor_msgs::JointState scopeMessage() {
  StepInput input;
  input.joints = {0.05, 0.1, -0.2, 0.3, 0.01, 1.5, 0.002};
  return makeJoints(input.joints, jointsOf(InputChannel::Scope), 123456789012);
}

/// What a recorded step used, bit for bit.
StepInput readStepInput(const vibe_msgs::StepInput& message) {
  StepInput input;
  std::copy(message.joints.begin(), message.joints.end(), input.joints.begin());
  std::copy(message.buttons.begin(), message.buttons.end(), input.buttons.begin());
  input.pull_particle = message.pull_particle;
  input.pull_target = {message.pull_target.x, message.pull_target.y, message.pull_target.z};
  input.breath = message.breath == 0 ? Breath::Free : Breath::Held;
  return input;
}

std::string jointError(const sensor_msgs::JointState& message, JointSource source = JointSource::Measured) {
  return sentenceOf([&] { readJoints(message, InputChannel::Scope, source); });
}

TEST(Conversions, jointsSurviveTheRoundTripBitForBit) {
  StepInput input;
  input.joints = {0.1 / 3, 1e-300, -0.0, 3.0, 0.01, 1.5, 0.002};
  const InputSample scope = readJoints(makeJoints(input.joints, jointsOf(InputChannel::Scope), 42), InputChannel::Scope,
                                       JointSource::Measured);
  const InputSample suturing_device = readJoints(makeJoints(input.joints, jointsOf(InputChannel::SuturingDevice), 42),
                                                 InputChannel::SuturingDevice, JointSource::Measured);
  EXPECT_EQ(scope.stamp, 42);
  for (int i = 0; i < kJointCount; ++i) {
    EXPECT_EQ(i < kScopeJointCount ? scope.joints[i] : suturing_device.joints[i], input.joints[i]) << kJointNames[i];
  }
}

TEST(Conversions, stepInputSurvivesTheRoundTripBitForBit) {
  StepInput input;
  input.joints = {0.1 / 3, -0.0, 1e-310, 3, 4, 5, 6};
  input.buttons = {1, 0, 1, 0, 0, 1};
  input.pull_particle = 4711;
  input.pull_target = {1e-310, -0.0, 0.1 / 3};
  const vibe_msgs::StepInput message = makeStepInput(input, 77, 1'016'666'667);
  EXPECT_EQ(message.step, 77u);
  EXPECT_EQ(message.header.stamp.toNSec(), 1'016'666'667u);
  const StepInput read = readStepInput(message);
  EXPECT_EQ(read.joints, input.joints);
  EXPECT_TRUE(std::signbit(read.joints[1]));
  EXPECT_EQ(read.buttons, input.buttons);
  EXPECT_EQ(read.pull_particle, 4711);
  EXPECT_EQ(read.pull_target, input.pull_target);
  EXPECT_TRUE(std::signbit(read.pull_target.y()));
}

/// An archive that changes the last bit of plain value number `target`; `count` is how many there are.
struct BitFlip {
  std::size_t target = static_cast<std::size_t>(-1), count = 0;
  template <class T>
  void block(T* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      if (count++ == target) *reinterpret_cast<unsigned char*>(data + i) ^= 1;
  }
};

/// The message carries every field of StepInput under the same name. A field that is added to StepInput alone fails
/// here.
TEST(Conversions, everyBitOfEveryFieldOfStepInputIsInTheMessage) {
  const std::string definition = ros::message_traits::definition<vibe_msgs::StepInput>();
  StepInput counted;
  visitFields(counted, [&](std::string_view name, const auto&) {
    EXPECT_NE(definition.find(" " + std::string(name) + "\n"), std::string::npos) << name;
  });
  EXPECT_EQ(makeStepInput(counted, 0, 0).version, kStepInputVersion);
  BitFlip all;
  transfer(all, counted);
  EXPECT_EQ(all.count, static_cast<std::size_t>(kJointCount + kButtonCount + 5));
  for (std::size_t i = 0; i < all.count; ++i) {
    StepInput input;
    BitFlip flip{i};
    transfer(flip, input);
    EXPECT_NE(firstDifference(input, StepInput()), "");
    EXPECT_EQ(firstDifference(input, readStepInput(makeStepInput(input, 0, 0))), "") << "value " << i;
  }
}

TEST(Conversions, jointsAreFoundByNameInAnyOrder) {
  sensor_msgs::JointState message = scopeMessage();
  std::swap(message.name[0], message.name[3]);
  std::swap(message.position[0], message.position[3]);
  EXPECT_EQ(readJoints(message, InputChannel::Scope, JointSource::Measured).joints[Insertion], 0.05);
}

TEST(Conversions, badJointsAreErrorsThatNameWhatIsWrong) {
  sensor_msgs::JointState message = scopeMessage();
  EXPECT_EQ(jointError(message), "");
  message.position[1] = kNan;
  expectMentions(jointError(message), "'rotation'");
  message.position[1] = std::numeric_limits<double>::infinity();
  expectMentions(jointError(message), "finite");
  message = scopeMessage();
  message.name[2] = "tip_updown";
  expectMentions(jointError(message), "'tip_updown'");
  message = scopeMessage();
  message.name[2] = message.name[1];
  expectMentions(jointError(message), "twice");
  message = scopeMessage();
  message.position.pop_back();
  expectMentions(jointError(message), "3 positions");
  message = scopeMessage();
  message.name.push_back("helix_advance");
  message.position.push_back(0);
  expectMentions(jointError(message), "5 names");
  message = scopeMessage();
  message.header.stamp = ros::Time();
  expectMentions(jointError(message), "stamp is 0");
}

TEST(Conversions, commandsMayLeaveOutStampAndNames) {
  sensor_msgs::JointState message = scopeMessage();
  message.header.stamp = ros::Time();
  message.name.clear();
  const InputSample sample = readJoints(message, InputChannel::Scope, JointSource::Commanded);
  EXPECT_EQ(sample.stamp, 0);
  EXPECT_EQ(sample.joints[TipLeftRight], 0.3);
  EXPECT_EQ(jointError(scopeMessage(), JointSource::Commanded), "");
  message.header.stamp = ros::Time(1);
  expectMentions(jointError(message, JointSource::Measured), "0 names");
}

TEST(Conversions, buttonsAreReadByPosition) {
  StepInput input;
  input.buttons = {0, 1, 0, 0, 0, 1};
  sensor_msgs::Joy message = makeButtons(input, 5);
  EXPECT_EQ(readButtons(message).buttons, input.buttons);
  message.buttons[HelixGrab] = 2;
  expectMentions(sentenceOf([&] { readButtons(message); }), "'helix_grab' is 2");
  message.buttons.resize(3);
  expectMentions(sentenceOf([&] { readButtons(message); }), "3 buttons");
}

geometry_msgs::PoseStamped poseMessage() {
  return makePose(Eigen::Translation3d(1, 2, 3) * Eigen::Quaterniond::Identity(), kWorldFrame, 9);
}

TEST(Conversions, tipTargetsKnowTheirFrame) {
  geometry_msgs::PoseStamped message = poseMessage();
  InputSample sample = readTipTarget(message);
  EXPECT_EQ(sample.target, ScopeTarget::TipInWorld);
  EXPECT_EQ(sample.tip_pose.translation(), Eigen::Vector3d(1, 2, 3));
  message.header.frame_id = "scope_base";
  EXPECT_EQ(readTipTarget(message).target, ScopeTarget::TipInBase);
  message.header.frame_id = "map";
  expectMentions(sentenceOf([&] { readTipTarget(message); }), "'map'");
  message.header.frame_id = "";  // of a CRTK client
  EXPECT_EQ(readTipTarget(message).target, ScopeTarget::TipInWorld);
  EXPECT_TRUE(readTipMove(message).move);
}

TEST(Conversions, badTipTargetsAreErrors) {
  geometry_msgs::PoseStamped message = poseMessage();
  message.pose.position.y = kNan;
  expectMentions(sentenceOf([&] { readTipTarget(message); }), "finite");
  message = poseMessage();
  message.pose.orientation.z = kNan;
  expectMentions(sentenceOf([&] { readTipTarget(message); }), "finite");
  message = poseMessage();
  message.pose.orientation.w = 0;
  expectMentions(sentenceOf([&] { readTipTarget(message); }), "unit quaternion");
}

TEST(Conversions, stampsBeforeZeroBecomeZero) {
  EXPECT_TRUE(toRosTime(-5).isZero());
  EXPECT_EQ(fromRosTime(toRosTime(1'234'567'890'123)), 1'234'567'890'123);
}

TEST(Conversions, wrenchIsThatOfTheStateInTheFrameOfTheTip) {
  State state;
  state.tool_force = {1, -2, 3};
  state.tool_torque = {0.1, 0.2, -0.3};
  const geometry_msgs::WrenchStamped message = makeWrench(state, 8);
  EXPECT_EQ(message.header.frame_id, "scope_tip");
  EXPECT_EQ(message.wrench.force.y, -2);
  EXPECT_EQ(message.wrench.torque.z, -0.3);
}

TEST(Conversions, hapticParametersKeepTheirContent) {
  ToolImpedance response;
  response.position = {1, 2, 3};
  response.velocity = {-1, 0, 1};
  response.force = {4, 5, 6};
  response.equilibrium = {7, 8, 9};
  response.stiffness << 11, 12, 13, 21, 22, 23, 31, 32, 33;
  response.damping = 2 * response.stiffness;
  response.joints[TipUpDown] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  const vibe_msgs::HapticParameters message = makeHapticParameters(response, 8, 1'000'000'005);
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.header.stamp.toNSec(), 1'000'000'005U);
  EXPECT_TRUE(message.touching);
  EXPECT_EQ(message.position.y, 2);
  EXPECT_EQ(message.velocity.x, -1);
  EXPECT_EQ(message.force.z, 6);
  EXPECT_EQ(message.equilibrium.x, 7);
  EXPECT_EQ(message.stiffness[5], 23);
  EXPECT_EQ(message.damping[3], 42);
  EXPECT_EQ(message.force_limit, 8);
  EXPECT_EQ(message.joint_name[TipUpDown], "tip_up_down");
  EXPECT_EQ(message.joint_position[TipUpDown], 0.1);
  EXPECT_EQ(message.joint_velocity[TipUpDown], 0.2);
  EXPECT_EQ(message.joint_effort[TipUpDown], 0.3);
  EXPECT_EQ(message.joint_stiffness[TipUpDown], 0.4);
  EXPECT_EQ(message.joint_damping[TipUpDown], 0.5);
  EXPECT_EQ(message.joint_equilibrium[TipUpDown], 0.6);
  EXPECT_FALSE(makeHapticRelease(8).touching);
  EXPECT_EQ(makeHapticRelease(8).stiffness[0], 0);
}

TEST(Conversions, eventsKeepTheirContent) {
  Event event;
  event.kind = Event::Kind::Slip;
  event.particle = 12;
  event.value = 8.5;
  event.limit = 4;
  event.amount = 1;
  const vibe_msgs::ProcedureEvent message = makeEvent(event, 3);
  EXPECT_EQ(message.kind, vibe_msgs::ProcedureEvent::SLIP);
  EXPECT_EQ(message.particle, 12);
  EXPECT_EQ(message.value, 8.5);
  EXPECT_EQ(message.text, "The tissue tore off the helix at 8.50 N; after 1.0 turns the helix holds 4.00 N.");
  const vibe_msgs::ProcedureEvent warning = makeWarning("The topic is silent.", 4'000'000'000);
  EXPECT_EQ(warning.kind, vibe_msgs::ProcedureEvent::WARNING);
  EXPECT_EQ(warning.particle, -1);
  EXPECT_EQ(warning.text, "The topic is silent.");
  EXPECT_EQ(warning.header.stamp.toNSec(), 4'000'000'000u);
}

TEST(Conversions, toolStateFollowsWhatHappens) {
  State state;
  StepInput input;
  EXPECT_STREQ(toolStateOf(state, input), "free");
  state.in_contact = true;
  EXPECT_STREQ(toolStateOf(state, input), "contact");
  input.buttons[Insufflate] = 1;
  EXPECT_STREQ(toolStateOf(state, input), "insufflation");
  state.pressure_reached = true;
  EXPECT_STREQ(toolStateOf(state, input), "contact");
  state.grip.emplace_back();
  EXPECT_STREQ(toolStateOf(state, input), "grip");
}

}  // namespace
}  // namespace vibe::sim::conversions_test
