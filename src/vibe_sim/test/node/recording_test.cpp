// Recordings read back from bags: of this release, of an older one, and what cannot be repeated.
#include "recording/recording.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StepInput.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include "conversions/input_message.hpp"
#include "sentences.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim::recording_test {
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
    return sentenceOf([this] { Recording{file}; });
  }
};

TEST_F(RecordingFile, HoldsSceneInputsAndHashes) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    for (int k = 0; k < 3; ++k) bag.write("/applied_input", ros::Time(2 + k), makeStepInput(inputOf(k), k, 0));
    vibe_msgs::SolverStatistics statistics;
    statistics.header.stamp = ros::Time(4);
    statistics.state_hash = "0123456789abcdef";
    bag.write("/solver_statistics", ros::Time(5), statistics);
  }
  const Recording recording(file);
  ASSERT_EQ(recording.runs().size(), 1U);
  const RecordedRun& run = recording.runs().front();
  EXPECT_EQ(run.scene, "name: recorded");
  ASSERT_EQ(run.steps.size(), 3U);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(firstDifference(run.steps[k].input, inputOf(k)), "");
  EXPECT_EQ(recording.stateHashes().find(4'000'000'000)->second, "0123456789abcdef");
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
  const Recording recording(file);
  ASSERT_EQ(recording.runs().front().steps.size(), 1U);
  EXPECT_EQ(firstDifference(recording.runs().front().steps[0].input, StepInput()), "");
}

TEST_F(RecordingFile, FromBeforeThereWereHashesIsReadWithoutThem) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    bag.write("/applied_input", ros::Time(2), foreignInput(0));
  }
  const Recording recording(file);
  ASSERT_EQ(recording.runs().front().steps.size(), 1U);
  EXPECT_FALSE(recording.runs().front().steps[0].has_hashes);
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

TEST_F(RecordingFile, WithoutATopicIsRejectedAndWithAGapReadUpToIt) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    bag.write("/applied_input", ros::Time(2), makeStepInput(inputOf(0), 0, 0));
  }
  expectMentions(errorOfReading(), "neither the topic scene nor session_info");
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
  const Recording recording(file);
  EXPECT_EQ(recording.runs().front().steps.size(), 1U);
  expectMentions(recording.lost(), "applied_input lacks 1 step in 1 place, first after step 0 of run 0");
}

void writeFile(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string readFile(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(RecordingFile, EmptyForeignMissingAndCutFilesHaveASentenceEach) {
  std::remove(file.c_str());
  expectMentions(errorOfReading(), "check the path");
  writeFile(file, "");
  expectMentions(errorOfReading(), "is empty");
  writeFile(file, "not a bag at all\n");
  expectMentions(errorOfReading(), "is not a bag");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    std_msgs::String other;
    bag.write("/chatter", ros::Time(2), other);
  }
  expectMentions(errorOfReading(), "not of this simulator");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    writeScene(bag);
    for (int k = 0; k < 3; ++k) bag.write("/applied_input", ros::Time(2 + k), makeStepInput(inputOf(k), k, 0));
  }
  EXPECT_EQ(errorOfReading(), "");
  const std::string whole = readFile(file);
  int sentences = 0;
  for (std::size_t size = 1; size < whole.size(); size += 97) {
    writeFile(file, whole.substr(0, size));
    const std::string sentence = errorOfReading();
    sentences += sentence.find(file) != std::string::npos;
    EXPECT_NE(sentence, "") << size;
  }
  EXPECT_GT(sentences, 10);
}

}  // namespace
}  // namespace vibe::sim::recording_test
