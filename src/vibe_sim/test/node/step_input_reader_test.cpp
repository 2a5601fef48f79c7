// Recorded inputs of this and of older releases, from the bytes and the definition in a bag.
#include "recording/step_input_reader.hpp"

#include <gtest/gtest.h>
#include <vibe_msgs/StepInput.h>

#include <cmath>
#include <cstring>

#include "conversions/input_message.hpp"
#include "sentences.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim::step_input_reader_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::string kHeaderDefinition =
    "================================================================================\n"
    "MSG: std_msgs/Header\n"
    "# Standard metadata, with a = in a comment\n"
    "uint32 seq\n"
    "time stamp\n"
    "string frame_id\n\n";
const std::string kPointDefinition =
    "================================================================================\n"
    "MSG: geometry_msgs/Point\n"
    "float64 x\nfloat64 y\nfloat64 z\n";

template <class T>
void put(T value, Bytes& bytes) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(bytes.data() + end, &value, sizeof value);
}

Bytes header(const std::string& frame) {
  Bytes bytes;
  put<std::uint32_t>(9, bytes);
  put<std::uint64_t>(123456, bytes);
  put(static_cast<std::uint32_t>(frame.size()), bytes);
  for (const char letter : frame) put(letter, bytes);
  return bytes;
}

StepInput sample() {
  StepInput input;
  input.joints = {0.1 / 3, -0.0, 1e-310, 3, 4, 5, 6};
  input.buttons = {1, 0, 1, 0, 0, 1};
  input.pull_particle = 4711;
  input.pull_target = {1e-310, -0.0, 0.1 / 3};
  return input;
}

void putControls(Bytes& bytes) {
  for (double joint : sample().joints) put(joint, bytes);
  for (std::uint8_t button : sample().buttons) put(button, bytes);
}

void putPull(Bytes& bytes) {
  put<std::int32_t>(sample().pull_particle, bytes);
  for (int k = 0; k < 3; ++k) put(sample().pull_target[k], bytes);
}

std::string errorOf(const StepInputReader& reader, const Bytes& bytes) {
  return sentenceOf([&] { reader.read(bytes.data(), bytes.size()); });
}

Bytes present() {
  const vibe_msgs::StepInput message = makeStepInput(sample(), 77, 1'016'666'667);
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

TEST(StepInputReader, ReadsWhatThisReleaseRecords) {
  const StepInputReader reader(ros::message_traits::definition<vibe_msgs::StepInput>());
  const Bytes bytes = present();
  const RecordedStep read = reader.read(bytes.data(), bytes.size());
  EXPECT_EQ(read.step, 77U);
  EXPECT_EQ(firstDifference(read.input, sample()), "");
}

TEST(StepInputReader, ReadsRecordingsWithoutAVersion) {
  const StepInputReader reader(
      "Header header\nuint64 step # counted from 0\nfloat64[7] joints\nuint8[6] buttons\n\nint32 pull_particle\n"
      "geometry_msgs/Point pull_target\n" +
      kHeaderDefinition + kPointDefinition);
  Bytes bytes = header("somewhere");
  put<std::uint64_t>(12, bytes);
  putControls(bytes);
  putPull(bytes);
  const RecordedStep read = reader.read(bytes.data(), bytes.size());
  EXPECT_EQ(read.step, 12U);
  EXPECT_EQ(firstDifference(read.input, sample()), "");
}

TEST(StepInputReader, ReadsRecordingsFromBeforeThePullSpring) {
  const StepInputReader reader("std_msgs/Header header\nuint64 step\nfloat64[7] joints\nuint8[6] buttons\n" +
                               kHeaderDefinition);
  Bytes bytes = header("");
  put<std::uint64_t>(3, bytes);
  putControls(bytes);
  const RecordedStep read = reader.read(bytes.data(), bytes.size());
  StepInput expected = sample();
  expected.pull_particle = -1;
  expected.pull_target.setZero();
  EXPECT_EQ(read.step, 3U);
  EXPECT_EQ(firstDifference(read.input, expected), "");
}

TEST(StepInputReader, FindsFieldsByNameAmongOthers) {
  const StepInputReader reader(
      "uint8 LIMIT=4\nfloat32[] weights\nstring[] notes\nuint32 version\nuint8[6] buttons\nfloat64[7] joints\n"
      "uint64 step\ngeometry_msgs/Point pull_target\nint32 pull_particle\nuint8 breath\n" +
      kPointDefinition);
  Bytes bytes;
  put<std::uint32_t>(2, bytes), put(1.5F, bytes), put(2.5F, bytes);
  put<std::uint32_t>(1, bytes), put<std::uint32_t>(3, bytes), put('a', bytes), put('b', bytes), put('c', bytes);
  put<std::uint32_t>(kStepInputVersion, bytes);
  for (std::uint8_t button : sample().buttons) put(button, bytes);
  for (double joint : sample().joints) put(joint, bytes);
  put<std::uint64_t>(5, bytes);
  for (int k = 0; k < 3; ++k) put(sample().pull_target[k], bytes);
  put<std::int32_t>(sample().pull_particle, bytes);
  put<std::uint8_t>(1, bytes);
  const RecordedStep read = reader.read(bytes.data(), bytes.size());
  StepInput expected = sample();
  expected.breath = Breath::Held;
  EXPECT_EQ(read.step, 5U);
  EXPECT_EQ(firstDifference(read.input, expected), "");
}

TEST(StepInputReader, RejectsANewerVersionByName) {
  const StepInputReader reader("uint64 step\nuint32 version\nfloat64[9] joints\n");
  Bytes bytes;
  put<std::uint64_t>(0, bytes);
  put<std::uint32_t>(7, bytes);
  for (int j = 0; j < 9; ++j) put(0.0, bytes);
  const std::string sentence = errorOf(reader, bytes);
  expectMentions(sentence, "version 7");
  expectMentions(sentence, "versions 1 to " + std::to_string(kStepInputVersion));
}

TEST(StepInputReader, RejectsOtherFieldsByName) {
  const StepInputReader reader("uint64 step\nuint32 version\nfloat64[9] joints\nuint8[6] buttons\n");
  Bytes bytes;
  put<std::uint64_t>(0, bytes);
  put<std::uint32_t>(kStepInputVersion, bytes);
  for (int j = 0; j < 9; ++j) put(0.0, bytes);
  put<std::uint32_t>(0, bytes), put<std::uint16_t>(0, bytes);
  expectMentions(errorOf(reader, bytes), "'float64[7] joints'");
}

TEST(StepInputReader, RejectsMessagesThatEndTooEarly) {
  const StepInputReader reader(ros::message_traits::definition<vibe_msgs::StepInput>());
  const Bytes whole = present();
  EXPECT_EQ(errorOf(reader, whole), "");
  for (std::size_t size = 0; size < whole.size(); ++size)
    expectMentions(errorOf(reader, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                   "ends too early");
}

TEST(StepInputReader, RejectsDefinitionsThatAreIncomplete) {
  EXPECT_THROW(StepInputReader("geometry_msgs/Point pull_target\n"), Error);
  EXPECT_THROW(StepInputReader("geometry_msgs/Point[] places\n" + kPointDefinition), Error);
  EXPECT_THROW(StepInputReader("a/A inner\n====\nMSG: a/A\na/A inner\n"), Error) << "a message in itself";
  std::string levels = "a0/A x\n";  // 8^12 fields
  for (int k = 0; k < 12; ++k) {
    levels += "====\nMSG: a" + std::to_string(k) + "/A\n";
    for (int i = 0; i < 8; ++i) levels += "a" + std::to_string(k + 1) + "/A x\n";
  }
  EXPECT_THROW(StepInputReader(levels + "====\nMSG: a12/A\nbool x\n"), Error);
}

}  // namespace
}  // namespace vibe::sim::step_input_reader_test
