#include "vision_messages.hpp"

#include <gtest/gtest.h>

#include "node/node_test_support.hpp"

namespace vibe::vision::vision_messages_test {
namespace {

constexpr double kTime = 1.7e9 + 0.0068027210884;  // [s]

class VisionMessages : public ::testing::Test {
 protected:
  VisionConfig config_ = twoInstruments();
  Measurements both_{trackedMeasurement(0.012, 7), trackedMeasurement(-0.003, std::nan(""))};
  Measurements one_{lostMeasurement(LostReason::Occluded), trackedMeasurement(-0.003, std::nan(""))};
};

TEST_F(VisionMessages, StampIsTheTimeToTheMicrosecond) {
  EXPECT_EQ(toStamp(1000.0068027210884).toNSec(), 1000006802721u);
  EXPECT_NEAR(static_cast<double>(toStamp(kTime).toNSec() - 1700000000000000000ULL), 6802721, 500);
}

TEST_F(VisionMessages, MeasuredJointsAreThoseOfTheConfiguration) {
  const auto message = makeMeasuredJoints(config_, kTime, samplesOf(config_, kTime, both_));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->header.stamp, toStamp(kTime));
  EXPECT_EQ(message->name, (std::vector<std::string>{"helix_advance", "helix_rotation", "needle_driver"}));
  ASSERT_EQ(message->position.size(), 3u);
  EXPECT_DOUBLE_EQ(message->position[0], 0.1 - 0.012);
  EXPECT_DOUBLE_EQ(message->position[1], 2 - 7.0);
  EXPECT_DOUBLE_EQ(message->position[2], -0.003);
  EXPECT_EQ(message->velocity, (std::vector<double>{0, 0, 0}));
}

TEST_F(VisionMessages, ALostInstrumentSilencesTheJoints) {
  const auto samples = samplesOf(config_, kTime, one_);
  EXPECT_FALSE(makeMeasuredJoints(config_, kTime, samples));
  EXPECT_FALSE(makePredictedJoints(config_, kTime, 0.014, samples));
}

TEST_F(VisionMessages, HeldJointsAreMarkedByTheirVelocity) {
  std::vector<double> last;
  EXPECT_FALSE(makeHeldJoints(config_, kTime, samplesOf(config_, kTime, one_), last));  // nothing to hold yet
  ASSERT_TRUE(makeHeldJoints(config_, kTime, samplesOf(config_, kTime, both_), last));
  one_[1].slide = 0.004;
  const auto held = makeHeldJoints(config_, kTime + 1, samplesOf(config_, kTime + 1, one_), last);
  ASSERT_TRUE(held);
  EXPECT_DOUBLE_EQ(held->position[0], 0.088);
  EXPECT_DOUBLE_EQ(held->position[1], -5);
  EXPECT_DOUBLE_EQ(held->position[2], 0.004);
  EXPECT_TRUE(std::isnan(held->velocity[0]));
  EXPECT_TRUE(std::isnan(held->velocity[1]));
  EXPECT_EQ(held->velocity[2], 0);
  const Measurements none(2, lostMeasurement(LostReason::NoFrame));
  EXPECT_FALSE(makeHeldJoints(config_, kTime + 2, samplesOf(config_, kTime + 2, none), last));
}

TEST_F(VisionMessages, PredictedJointsAreStampedWithTheirTime) {
  InstrumentPredictor helix(config_.instruments[0]), driver(config_.instruments[1]);
  std::vector<JointSample> samples(2);
  for (int k = 0; k < 100; ++k) {
    const double time = kTime + k / 147.0;
    samples[0] = helix.update(time, trackedMeasurement(0.1 * k / 147.0, 3.0 * k / 147.0));
    samples[1] = driver.update(time, trackedMeasurement(-0.05 * k / 147.0, 0));
  }
  const double time = kTime + 99 / 147.0;
  const auto message = makePredictedJoints(config_, time, 0.014, samples);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->header.stamp, toStamp(time + 0.014));
  EXPECT_NEAR(message->position[0], 0.1 - 0.1 * (99 / 147.0 + 0.014), 1e-6);
  EXPECT_NEAR(message->position[1], 2 - 3.0 * (99 / 147.0 + 0.014), 1e-3);
  EXPECT_NEAR(message->position[2], -0.05 * (99 / 147.0 + 0.014), 1e-6);
  EXPECT_NEAR(message->velocity[0], -0.1, 1e-4);
}

TEST_F(VisionMessages, TracksSayEverythingAboutTheFrame) {
  Frame frame;
  frame.stamp = kTime;
  frame.sequence = 17;
  frame.exposure = 0.002;
  const auto message =
      makeTracks(config_, frame, both_, samplesOf(config_, kTime, both_), "camera", {0.001, 0.002, 0.003, 0.004});
  EXPECT_EQ(message.header.stamp, toStamp(kTime));
  EXPECT_EQ(message.header.frame_id, "camera");
  EXPECT_EQ(message.frame_sequence, 17u);
  EXPECT_EQ(message.exposure, 0.002);
  EXPECT_EQ(message.transport, 0.001);
  EXPECT_EQ(message.wait, 0.002);
  EXPECT_EQ(message.track, 0.003);
  EXPECT_EQ(message.publish, 0.004);
  ASSERT_EQ(message.instruments.size(), 2u);
  const vibe_msgs::InstrumentTrack& helix = message.instruments[0];
  EXPECT_EQ(helix.name, "helix");
  EXPECT_TRUE(helix.tracked);
  EXPECT_EQ(helix.reason, vibe_msgs::InstrumentTrack::TRACKED);
  EXPECT_DOUBLE_EQ(helix.slide, 0.088);
  EXPECT_DOUBLE_EQ(helix.rotation, -5);
  EXPECT_DOUBLE_EQ(helix.covariance[0], 1e-12);
  EXPECT_DOUBLE_EQ(helix.covariance[1], 2e-10);  // both signs are negative
  EXPECT_DOUBLE_EQ(helix.covariance[2], 2e-10);
  EXPECT_DOUBLE_EQ(helix.covariance[3], 1e-6);
  EXPECT_EQ(helix.pixel_x, 400.25);
  EXPECT_EQ(helix.pixel_y, 120.5);
  EXPECT_DOUBLE_EQ(helix.pixel_deviation, 0.01);
  EXPECT_TRUE(std::isnan(message.instruments[1].rotation));
}

TEST_F(VisionMessages, TracksOfALostInstrumentHaveNoNumbers) {
  const auto message = makeTracks(config_, Frame(), one_, samplesOf(config_, kTime, one_), "camera", {});
  const vibe_msgs::InstrumentTrack& helix = message.instruments[0];
  EXPECT_FALSE(helix.tracked);
  EXPECT_EQ(helix.reason, vibe_msgs::InstrumentTrack::OCCLUDED);
  for (const double value : {helix.slide, helix.rotation, helix.covariance[0], helix.covariance[1], helix.covariance[2],
                             helix.covariance[3], helix.pixel_x, helix.pixel_y, helix.pixel_deviation, helix.scale})
    EXPECT_TRUE(std::isnan(value));
  EXPECT_EQ(helix.score, 0);
}

TEST_F(VisionMessages, DoubtsHaveTheWordsOfTheTable) {
  Frame frame;
  frame.stamp = kTime;
  frame.sequence = 17;
  both_[0].doubt = Doubt::Askew;
  const auto message = makeDoubts(config_, frame, both_, "camera");
  EXPECT_EQ(message.header.stamp, toStamp(kTime));
  EXPECT_EQ(message.header.frame_id, "camera");
  EXPECT_EQ(message.frame_sequence, 17u);
  EXPECT_EQ(message.instruments, (std::vector<std::string>{"helix", "needle_driver"}));
  EXPECT_EQ(message.doubts, (std::vector<std::string>{"askew", ""}));
  both_[0].reason = LostReason::Occluded;  // what was doubted before says nothing of this frame
  EXPECT_EQ(makeDoubts(config_, frame, both_, "camera").doubts, (std::vector<std::string>{"", ""}));
}

TEST_F(VisionMessages, NumbersOfReasonsAreThoseOfTheMessage) {
  using vibe_msgs::InstrumentTrack;
  EXPECT_EQ(static_cast<int>(LostReason::None), InstrumentTrack::TRACKED);
  EXPECT_EQ(static_cast<int>(LostReason::NotFound), InstrumentTrack::NOT_FOUND);
  EXPECT_EQ(static_cast<int>(LostReason::Occluded), InstrumentTrack::OCCLUDED);
  EXPECT_EQ(static_cast<int>(LostReason::Saturated), InstrumentTrack::SATURATED);
  EXPECT_EQ(static_cast<int>(LostReason::Dark), InstrumentTrack::DARK);
  EXPECT_EQ(static_cast<int>(LostReason::Mismatch), InstrumentTrack::MISMATCH);
  EXPECT_EQ(static_cast<int>(LostReason::Jump), InstrumentTrack::JUMP);
  EXPECT_EQ(static_cast<int>(LostReason::OutOfView), InstrumentTrack::OUT_OF_VIEW);
  EXPECT_EQ(static_cast<int>(LostReason::WrongImage), InstrumentTrack::WRONG_IMAGE);
  EXPECT_EQ(static_cast<int>(LostReason::NoFrame), InstrumentTrack::NO_FRAME);
}

TEST_F(VisionMessages, DatagramHasTheEstimatesOfTheJoints) {
  Frame frame;
  frame.stamp = kTime;
  frame.sequence = 17;
  frame.exposure = 0.002;
  const auto samples = samplesOf(config_, kTime, both_);
  const TrackDatagram datagram = makeDatagram(frame, both_, samples);
  EXPECT_EQ(datagram.stamp, kTime);
  EXPECT_EQ(datagram.frame_sequence, 17u);
  EXPECT_FLOAT_EQ(datagram.exposure, 0.002F);
  EXPECT_FLOAT_EQ(datagram.jerk_time, 0.1F);
  ASSERT_EQ(datagram.instruments.size(), 2u);
  const InstrumentSample& helix = datagram.instruments[0];
  EXPECT_TRUE(helix.tracked && helix.has_rotation);
  EXPECT_DOUBLE_EQ(helix.slide.position, 0.088);
  EXPECT_DOUBLE_EQ(helix.rotation.position, -5);
  const Eigen::Matrix4d& covariance = samples[0].slide_motion.covariance;
  EXPECT_FLOAT_EQ(helix.slide.covariance[0], static_cast<float>(covariance(0, 0)));
  EXPECT_FLOAT_EQ(helix.slide.covariance[4], static_cast<float>(covariance(1, 1)));
  EXPECT_FLOAT_EQ(helix.slide.covariance[7], static_cast<float>(covariance(2, 2)));
  EXPECT_FLOAT_EQ(helix.slide.covariance[9], static_cast<float>(covariance(3, 3)));
  const InstrumentSample& driver = datagram.instruments[1];
  EXPECT_TRUE(driver.tracked);
  EXPECT_FALSE(driver.has_rotation);
  EXPECT_TRUE(std::isnan(driver.rotation.position));
}

TEST_F(VisionMessages, DatagramOfALostInstrumentHasNoNumbers) {
  const InstrumentSample helix = makeDatagram(Frame(), one_, samplesOf(config_, kTime, one_)).instruments[0];
  EXPECT_FALSE(helix.tracked);
  EXPECT_EQ(helix.reason, 2);
  EXPECT_TRUE(std::isnan(helix.slide.position) && std::isnan(helix.slide.jerk) && std::isnan(helix.rotation.velocity));
  EXPECT_TRUE(std::isnan(helix.slide.covariance[0]));
}

}  // namespace
}  // namespace vibe::vision::vision_messages_test
