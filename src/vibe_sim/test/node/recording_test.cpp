// Recordings read back from bags: of this release, of an older one, and what cannot be repeated.
#include "recording.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StepInput.h>

#include <cstdio>
#include <cstring>

#include "conversions.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/input/step_input_fields.hpp"

namespace vibe {
namespace {

class RecordingFile : public ::testing::Test {
 protected:
  std::string file = ::testing::TempDir() + "vibe_recording_test.bag";
  ~RecordingFile() override { std::remove(file.c_str()); }

  static StepInput inputOf(int step) {
    StepInput input;
    input.joints[Rotation] = 0.1 * step;
    input.pull_particle = step;
    return input;
  }

  void writeScene(rosbag::Bag& bag) {
    std_msgs::String scene;
    scene.data = "name: recorded";
    bag.write("/scene", ros::Time(1), scene);
  }

  std::string errorOfReading() {
    try {
      readRecording(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

void expectMentions(const std::string& sentence, const std::string& part) {
  EXPECT_NE(sentence.find(part), std::string::npos) << "'" << sentence << "' lacks '" << part << "'";
}

TEST_F(RecordingFile, HoldsSceneInputsAndHashes) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    for (int k = 0; k < 3; ++k) bag.write("/applied_input", ros::Time(2 + k), makeStepInput(inputOf(k), k, 0));
    vibe_msgs::SolverStatistics statistics;
    statistics.steps = 3;
    statistics.state_hash = "0123456789abcdef";
    bag.write("/solver_statistics", ros::Time(5), statistics);
  }
  const Recording recording = readRecording(file);
  EXPECT_EQ(recording.scene, "name: recorded");
  ASSERT_EQ(recording.inputs.size(), 3U);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(firstDifference(recording.inputs[k], inputOf(k)), "");
  EXPECT_EQ(recording.hashes.at(3), "0123456789abcdef");
  EXPECT_TRUE(recording.comparable);
}

// A message of another release: step and controls only, with a version unless it is 0.
topic_tools::ShapeShifter foreignInput(std::uint32_t version) {
  std::vector<std::uint8_t> bytes((version == 0 ? 8 : 12) + 7 * 8 + 6);
  if (version != 0) std::memcpy(bytes.data() + 8, &version, sizeof version);
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  topic_tools::ShapeShifter message;
  message.morph(
      version == 0 ? "1f585b34d516cf0e67cc5d0690fb16bb" : "00112233445566778899aabbccddeeff", "vibe_msgs/StepInput",
      std::string("uint64 step\n") + (version == 0 ? "" : "uint32 version\n") + "float64[7] joints\nuint8[6] buttons\n",
      "");
  message.read(stream);
  return message;
}

TEST_F(RecordingFile, OfAnotherReleaseIsReadIfItsVersionIsKnown) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    bag.write("/applied_input", ros::Time(2), foreignInput(1));
  }
  const Recording recording = readRecording(file);
  ASSERT_EQ(recording.inputs.size(), 1U);
  EXPECT_TRUE(recording.comparable);
  EXPECT_EQ(firstDifference(recording.inputs[0], StepInput()), "");
}

TEST_F(RecordingFile, FromBeforeThereWereVersionsIsReadButItsHashesAreNotComparable) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    bag.write("/applied_input", ros::Time(2), foreignInput(0));
  }
  const Recording recording = readRecording(file);
  ASSERT_EQ(recording.inputs.size(), 1U);
  EXPECT_FALSE(recording.comparable);
}

TEST_F(RecordingFile, OfAnUnknownVersionIsRejectedByName) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    bag.write("/applied_input", ros::Time(2), foreignInput(9));
  }
  expectMentions(errorOfReading(), file);
  expectMentions(errorOfReading(), "version 9");
  expectMentions(errorOfReading(), "versions 1 to " + std::to_string(kStepInputVersion));
}

TEST_F(RecordingFile, WithAGapOrWithoutATopicIsRejected) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    bag.write("/applied_input", ros::Time(2), makeStepInput(inputOf(0), 0, 0));
  }
  expectMentions(errorOfReading(), "no topic scene");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
  }
  expectMentions(errorOfReading(), "no topic applied_input");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    bag.write("/applied_input", ros::Time(2), makeStepInput(inputOf(0), 0, 0));
    bag.write("/applied_input", ros::Time(3), makeStepInput(inputOf(2), 2, 0));
  }
  expectMentions(errorOfReading(), "step 2 where step 1");
}

}  // namespace
}  // namespace vibe
