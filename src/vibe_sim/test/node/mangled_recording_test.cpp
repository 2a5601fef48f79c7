// Recordings that tools and accidents have changed: several sessions in one bag, topics, times and bytes that are
// missing, messages twice. Each is read as far as it goes, or refused by what is missing.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StateSnapshot.h>
#include <vibe_msgs/StepInput.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "conversions/input_message.hpp"
#include "recording/recording.hpp"
#include "replay/bag_filler.hpp"
#include "sentences.hpp"

namespace vibe::sim::mangled_recording_test {
namespace {

constexpr std::uint64_t kFirst = 0x1111222233334444, kSecond = 0xaaaabbbbccccdddd;

// A session of 100 steps of 0.1 s in its first run and 20 in its second; a snapshot every 30 steps of a run.
struct Simulator {
  std::uint64_t id = kFirst;
  std::string prefix = "/";
  int begin = 10;          // [s]
  std::uint32_t mark = 1;  // in the hashes, so that sessions differ
};

void writeRun(rosbag::Bag& bag, const Simulator& of, std::uint32_t run, int steps, ros::Time time) {
  vibe_msgs::SessionInfo info;
  info.session = of.id, info.run = run, info.scene = "name: scene" + std::to_string(of.mark) + "\n";
  bag.write(of.prefix + "session_info", time, info);
  std_msgs::String scene;
  scene.data = info.scene;
  if (run == 1) bag.write(of.prefix + "scene", time, scene);
  for (int k = 0; k < steps; ++k, time += ros::Duration(0.1)) {
    vibe_msgs::StepInput input = makeStepInput(StepInput(), k, static_cast<std::int64_t>(time.toNSec()));
    input.session = of.id, input.run = run, input.input_hash = of.mark, input.state_hash = of.mark * 1000 + k;
    if (k % 30 == 0) {
      vibe_msgs::StateSnapshot snapshot;
      snapshot.header.stamp = time;
      snapshot.session = of.id, snapshot.run = run, snapshot.step = k;
      snapshot.data = {static_cast<std::uint8_t>(of.mark), static_cast<std::uint8_t>(k)};
      bag.write(of.prefix + "snapshot", time, snapshot);
    }
    bag.write(of.prefix + "applied_input", time, input);
  }
}

void write(rosbag::Bag& bag, const Simulator& of) {
  writeRun(bag, of, 1, 100, ros::Time(of.begin));
  writeRun(bag, of, 2, 20, ros::Time(of.begin + 10));
}

using Kept = std::function<bool(const rosbag::MessageInstance&)>;

// A copy of the messages that are kept.
void copy(const std::string& from, rosbag::Bag& out, const Kept& keeps) {
  rosbag::Bag in(from, rosbag::bagmode::Read);
  for (const rosbag::MessageInstance& message : rosbag::View(in))
    if (keeps(message)) out.write(message.getTopic(), message.getTime(), message);
}

Kept only(const std::set<std::string>& topics) {
  return [topics](const rosbag::MessageInstance& m) { return topics.count(m.getTopic()) > 0; };
}

Kept without(const std::set<std::string>& topics) {
  return [topics](const rosbag::MessageInstance& m) { return topics.count(m.getTopic()) == 0; };
}

Kept between(double begin, double end) {
  return
      [=](const rosbag::MessageInstance& m) { return m.getTime() >= ros::Time(begin) && m.getTime() < ros::Time(end); };
}

// The inputs of these steps of the first run are left out.
Kept withoutSteps(std::uint64_t begin, std::uint64_t end) {
  return [=](const rosbag::MessageInstance& m) {
    const auto input = m.instantiate<vibe_msgs::StepInput>();
    return !input || input->run > 1 || input->step < begin || input->step >= end;
  };
}

std::size_t stepsOf(const Recording& recording) {
  std::size_t count = 0;
  for (const RecordedRun& run : recording.runs()) count += run.steps.size();
  return count;
}

class MangledRecording : public ::testing::Test {
 protected:
  std::string whole = ::testing::TempDir() + "vibe_mangled_whole.bag";
  std::string file = ::testing::TempDir() + "vibe_mangled.bag";
  std::string other = ::testing::TempDir() + "vibe_mangled_other.bag";

  MangledRecording() {
    rosbag::Bag bag(whole, rosbag::bagmode::Write);
    write(bag, {});
  }
  ~MangledRecording() override {
    for (const std::string& each : {whole, file, other}) std::remove(each.c_str());
  }

  void mangle(const Kept& keeps) {
    rosbag::Bag out(file, rosbag::bagmode::Write);
    copy(whole, out, keeps);
  }
  void writeAll(const std::vector<Simulator>& simulators) {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    for (const Simulator& each : simulators) write(bag, each);
  }
  std::string refusal(const SessionChoice& choice = {}) {
    return sentenceOf([&] { Recording(file, choice); });
  }
};

TEST_F(MangledRecording, OneSessionIsReadWhole) {
  const Recording recording(whole);
  EXPECT_EQ(recording.runs().size(), 2U);
  EXPECT_EQ(stepsOf(recording), 120U);
  EXPECT_EQ(recording.session().idText(), "1111222233334444");
  EXPECT_EQ(recording.remarkOnChoice() + recording.lost(), "");
}

// Restarted later, as in wall time; at the same times, as in simulated time; in namespaces; shorter or first in time.
TEST_F(MangledRecording, SessionsInOneBagAreToldApart) {
  const std::vector<std::vector<Simulator>> cases = {{{}, {kSecond, "/", 40, 2}},
                                                     {{}, {kSecond, "/", 10, 2}},
                                                     {{kFirst, "/left/"}, {kSecond, "/right/", 10, 2}},
                                                     {{}, {kSecond, "/right/", 11, 2}},
                                                     {{kFirst, "/a/b/"}, {kSecond, "/a/", 30, 2}}};
  for (const auto& simulators : cases) {
    writeAll(simulators);
    for (const std::string choice : {"1", "2", "1111222233334444", "aaaa"}) {
      const Recording recording(file, {"", choice});
      const bool is_first = choice == "1" || choice[1] == '1';
      const Simulator& meant = simulators[is_first ? 0 : 1];
      EXPECT_EQ(recording.session().id, meant.id);
      EXPECT_EQ(stepsOf(recording), 120U);
      EXPECT_EQ(recording.runs()[0].scene, "name: scene" + std::to_string(meant.mark) + "\n");
      EXPECT_EQ(recording.snapshot(recording.runs()[0], 30)[0], static_cast<char>(meant.mark));
      EXPECT_EQ(recording.lost(), "");
    }
    expectMentions(Recording(file).remarkOnChoice(), "holds 2 sessions; this is number 1 (1111222233334444 in /");
  }
}

TEST_F(MangledRecording, ASessionIsChosenByItsNamespace) {
  writeAll({{kFirst, "/left/"}, {kSecond, "/right/", 10, 2}});
  for (const std::string name : {"right", "/right", "/right/", "right/"})
    EXPECT_EQ(Recording(file, {name, ""}).session().id, kSecond);
  expectMentions(refusal({"/middle", ""}), "in the namespace '/middle', but 1 (1111222233334444 in /left), 2 (aaaa");
  expectMentions(refusal({"/left", "2"}), "no session '2' in the namespace '/left'");
  expectMentions(refusal({"", "3"}), "no session '3', but 1 (");
  expectMentions(refusal({"", "aaab"}), "no session 'aaab'");
  EXPECT_EQ(listSessions({file})[1].stepCount(), 120U);
}

TEST_F(MangledRecording, IdentitiesThatBeginAlikeAreChosenByNumber) {
  writeAll({{}, {kFirst + 1, "/", 40, 2}});
  expectMentions(refusal({"", "11112222"}), "several sessions '11112222'");
  EXPECT_EQ(Recording(file, {"", "2"}).session().id, kFirst + 1);
}

// The messages of a release before there were identities.
template <class M>
void writeFormer(rosbag::Bag& bag, const std::string& topic, const ros::Time& time, const M& message, const char* md5) {
  const std::uint32_t size = ros::serialization::serializationLength(message);
  std::vector<std::uint8_t> bytes(size);
  ros::serialization::OStream out(bytes.data(), size);
  ros::serialization::serialize(out, message);
  ros::serialization::IStream in(bytes.data(), size - static_cast<std::uint32_t>(sizeof(std::uint64_t)));
  std::string definition = ros::message_traits::definition(message);
  const std::size_t field = definition.find("uint64 session\n");
  definition.erase(field, std::string("uint64 session\n").size());
  topic_tools::ShapeShifter former;
  former.morph(md5, ros::message_traits::datatype(message), definition, "");
  former.read(in);
  bag.write(topic, time, former);
}

void copyAsFormer(const std::string& from, const std::string& to) {
  rosbag::Bag in(from, rosbag::bagmode::Read), out(to, rosbag::bagmode::Write);
  for (const rosbag::MessageInstance& m : rosbag::View(in)) {
    if (const auto input = m.instantiate<vibe_msgs::StepInput>())
      writeFormer(out, m.getTopic(), m.getTime(), *input, "44258b1133a5ce99060ab84bdac01ebc");
    else if (const auto info = m.instantiate<vibe_msgs::SessionInfo>())
      writeFormer(out, m.getTopic(), m.getTime(), *info, "32fa7a67ace4e657f57bf111c84f40e2");
    else if (const auto snapshot = m.instantiate<vibe_msgs::StateSnapshot>())
      writeFormer(out, m.getTopic(), m.getTime(), *snapshot, "b55268b4f8de9782e13eb08f44c66a10");
    else
      out.write(m.getTopic(), m.getTime(), m);
  }
}

TEST_F(MangledRecording, OfAReleaseWithoutIdentitiesIsReadAlsoWhereTheSimulatorWasRestarted) {
  copyAsFormer(whole, file);
  {
    const Recording recording(file);
    EXPECT_EQ(recording.session().idText(), "-");
    EXPECT_EQ(stepsOf(recording), 120U);
    ASSERT_TRUE(recording.runs()[1].info);
    EXPECT_EQ(recording.snapshot(recording.runs()[0], 60).size(), 2U);
  }
  writeAll({{}, {kSecond, "/", 40, 2}});
  copyAsFormer(file, other);
  for (int number : {1, 2}) {
    const Recording recording(other, {"", std::to_string(number)});
    EXPECT_EQ(stepsOf(recording), 120U);
    EXPECT_EQ(recording.runs()[0].info->scene, "name: scene" + std::to_string(number) + "\n");
    EXPECT_EQ(recording.snapshot(recording.runs()[0], 30)[0], static_cast<char>(number));
    expectMentions(recording.remarkOnChoice(), "number " + std::to_string(number) + " (without identity in /)");
  }
  writeAll({{}, {kSecond, "/", 10, 2}});  // at the same times: nothing tells them apart
  copyAsFormer(file, other);
  expectMentions(sentenceOf([&] { Recording{other}; }), "twice, with different content");
}

TEST_F(MangledRecording, MissingTopicsAreNamed) {
  struct Case {
    std::set<std::string> kept;
    std::string sentence;
  };
  for (const Case& c : std::vector<Case>{
           {{"/scene"}, "has no topic applied_input with steps, which a replay repeats, but /scene; if topics"},
           {{"/session_info", "/snapshot"}, "has no topic applied_input with steps, which a replay repeats, but "},
           {{"/applied_input"}, "has neither the topic scene nor session_info"},
           {{"/applied_input", "/snapshot"}, "has neither the topic scene nor session_info"},
           {{}, "no message at all"}}) {
    mangle(only(c.kept));
    expectMentions(refusal(), c.sentence);
  }
  mangle(only({"/applied_input", "/scene"}));
  EXPECT_EQ(stepsOf(Recording(file)), 100U);
  expectMentions(Recording(file).lost(), "no snapshot from which 20 steps could be repeated, first step 0 of run 2");
  mangle(without({"/session_info"}));
  EXPECT_EQ(Recording(file).runs()[0].scene, "name: scene1\n");
  mangle(without({"/scene"}));
  EXPECT_EQ(stepsOf(Recording(file)), 120U);
}

TEST_F(MangledRecording, WhatIsNoBagIsCalledThat) {
  for (const auto& [content, sentence] : std::vector<std::pair<std::string, std::string>>{
           {"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n", "is a Git LFS pointer"},
           {"<html></html>\n", "is a web page (HTML)"},
           {"hello\n", "is not a bag: it does not begin with"},
           {"#ROSBAG V1.2\n", "is a bag of another format than 2.0"},
           {"#ROSBAG V2.0\n", "cannot be read to its end"}}) {
    std::ofstream(file, std::ios::binary) << content;
    expectMentions(refusal(), sentence);
  }
}

TEST_F(MangledRecording, APartInTimeIsReadFromItsFirstSnapshot) {
  mangle([](const auto& m) { return between(14, 99)(m) || m.getTopic() == "/session_info"; });
  EXPECT_EQ(stepsOf(Recording(file)), 60U);
  EXPECT_EQ(Recording(file).stepsLeftOut(), 20U);
  mangle([](const auto& m) { return between(14, 15.9)(m) || m.getTopic() == "/scene"; });
  expectMentions(refusal(), "no step that a replay can begin from: it has not step 0 of the session, and no snapshot.");
  mangle(between(10, 15));
  EXPECT_EQ(stepsOf(Recording(file)), 50U);
  EXPECT_EQ(Recording(file).lost(), "");
  mangle(between(15, 19));
  expectMentions(refusal(), "if it is a part of a split recording, give the first part as well");
}

TEST_F(MangledRecording, ThePartsOfASplitRecordingAreReadAsOne) {
  mangle(between(10, 14.05));
  {
    rosbag::Bag out(other, rosbag::bagmode::Write);
    copy(whole, out, between(14.05, 99));
  }
  for (const auto& files : {std::vector<std::string>{file, other}, std::vector<std::string>{other, file}}) {
    const Recording recording(files);
    EXPECT_EQ(stepsOf(recording), 120U);
    EXPECT_EQ(recording.lost(), "");
    EXPECT_EQ(recording.snapshot(recording.runs()[0], 60)[1], 60);
  }
}

TEST_F(MangledRecording, StepsThatAreMissingAreNamedAndTheRestIsRead) {
  mangle(withoutSteps(40, 45));
  {
    const Recording recording(file);
    ASSERT_EQ(recording.runs().size(), 3U);
    EXPECT_EQ(recording.runs()[1].firstStep(), 60U);
    EXPECT_EQ(stepsOf(recording), 40U + 40 + 20);
    EXPECT_EQ(recording.lost(),
              "applied_input lacks 5 steps in 1 place, first after step 39 of run 1; there is no snapshot from which "
              "15 steps "
              "could be repeated, first step 45 of run 1");
  }
  mangle(withoutSteps(0, 1));
  EXPECT_EQ(Recording(file).stepsLeftOut(), 29U);
  mangle(withoutSteps(99, 100));
  EXPECT_EQ(Recording(file).lost(), "");  // nothing tells that there was one
  mangle([](const auto& m) {
    const auto input = m.template instantiate<vibe_msgs::StepInput>();
    return !input || input->step % 2 == 0;
  });
  EXPECT_EQ(Recording(file).runs()[1].firstStep(), 30U);
}

TEST_F(MangledRecording, MergedBagsAreReadOnce) {
  for (const auto& [begin, end] : {std::pair{10.0, 99.0}, std::pair{12.0, 15.0}}) {
    rosbag::Bag out(file, rosbag::bagmode::Write);
    copy(whole, out, without({}));
    copy(whole, out, between(begin, end));
    out.close();
    EXPECT_EQ(stepsOf(Recording(file)), 120U);
    EXPECT_EQ(Recording(file).sessions().size(), 1U);
    EXPECT_EQ(Recording(file).lost(), "");
  }
  EXPECT_EQ(stepsOf(Recording({whole, whole})), 120U);
}

// What replay --fill copies: by identity, and without one by time, where sessions follow each other.
TEST_F(MangledRecording, OnlyTheChosenSessionIsFilled) {
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    write(bag, {});
    write(bag, {kSecond, "/", 40, 2});
    write(bag, {kSecond + 1, "/right/", 11, 3});
    for (const int second : {12, 39, 41, 60}) bag.write("/note", ros::Time(second), std_msgs::String());
  }
  for (const std::string choice : {"1", "2"}) {
    const Recording recording(file, {"", choice});
    const SessionFilter filter(recording);
    std::map<std::string, std::vector<double>> times;
    const auto all = recording.view([](const rosbag::ConnectionInfo*) { return true; });
    for (const rosbag::MessageInstance& message : *all)
      if (filter.has(message)) times[message.getTopic()].push_back(message.getTime().toSec());
    EXPECT_EQ(times["/applied_input"].size(), 120U);
    EXPECT_EQ(times["/snapshot"].size(), 5U);
    EXPECT_EQ(times["/right/applied_input"].size(), 120U);
    EXPECT_EQ(times["/scene"], std::vector<double>{choice == "1" ? 10.0 : 40.0});
    EXPECT_EQ(times["/note"], choice == "1" ? (std::vector<double>{12, 39}) : (std::vector<double>{41, 60}));
  }
  const SessionFilter filter(Recording(file, {"/right", ""}));  // alone in its namespace
  for (const std::uint64_t id : {kSecond, std::uint64_t{0}}) {
    writeAll({{id == 0 ? id : kFirst}, {id, "/", id == 0 ? 40 : 15, 2}});
    const Recording recording(file, {"", "1"});
    expectMentions(sentenceOf([&] { SessionFilter{recording}; }), "cannot be filled: it holds several sessions in");
  }
}

TEST_F(MangledRecording, AStepThatComesTwiceAndDiffersIsRefused) {
  rosbag::Bag out(file, rosbag::bagmode::Write);
  copy(whole, out, without({}));
  vibe_msgs::StepInput input = makeStepInput(StepInput(), 50, 15'000'000'000);
  input.session = kFirst, input.run = 1, input.state_hash = 7;
  out.write("/applied_input", ros::Time(99), input);
  out.close();
  expectMentions(refusal(),
                 "has step 50 of run 1 twice, with different content: one of them may have been edited; give");
}

TEST_F(MangledRecording, NamespacesMayBeChangedAndFilesCompressed) {
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    rosbag::Bag in(whole, rosbag::bagmode::Read), out(file, rosbag::bagmode::Write);
    out.setCompression(compression);
    for (const rosbag::MessageInstance& m : rosbag::View(in)) out.write("/robot1" + m.getTopic(), m.getTime(), m);
    out.close();
    const Recording recording(file);
    EXPECT_EQ(recording.session().nameSpace(), "/robot1");
    EXPECT_EQ(stepsOf(recording), 120U);
    EXPECT_EQ(recording.snapshot(recording.runs()[1], 0)[1], 0);
  }
}

// The default is the first one, and where it cannot be replayed the sentence says that there are others.
TEST_F(MangledRecording, ARefusalMentionsTheOtherSessions) {
  {
    rosbag::Bag bag(other, rosbag::bagmode::Write);
    write(bag, {});
    write(bag, {kSecond, "/", 40, 2});
    bag.close();
    rosbag::Bag out(file, rosbag::bagmode::Write);
    copy(other, out, [](const auto& m) { return m.getTime() >= ros::Time(40) || between(14, 15)(m); });
  }
  expectMentions(refusal(), "no snapshot");
  expectMentions(refusal(), "holds 2 sessions; this is number 1");
  EXPECT_EQ(stepsOf(Recording(file, {"", "2"})), 120U);
}

}  // namespace
}  // namespace vibe::sim::mangled_recording_test
