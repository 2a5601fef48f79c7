// A session recorded without a graph, repeated, edited, filled up again, and begun from its snapshots.
#include "replay/replay.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <topic_tools/shape_shifter.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StepInput.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>

#include "publishing/publishers.hpp"
#include "recording/recording.hpp"
#include "replay/bag_filler.hpp"
#include "sentences.hpp"
#include "simulation/scene_source.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe::sim::replay_test {
namespace {

constexpr int kSteps = 660;      // of the first run: one snapshot at its start and one 10 s later
constexpr int kStepsAfter = 30;  // of the second
constexpr std::int64_t kOrigin = 5'000'000'000;

const char kScene[] =
    "name: small\n"
    "geometry: {kind: stomach, particles: 400}\n"
    "attachments: {oesophagus: true, duodenum: true}\n"
    "gas: {initial_pressure: 5 mmHg, insufflator_on: false}\n"
    "foundation: {stiffness: 5 kPa/m}\n"
    "scope: {}\n"
    "helix: {reach: 12 mm}\n"
    "suture: {}\n";

using Edit = std::function<void(vibe_msgs::StepInput&)>;

// The scope goes in, turns and bends; the helix grabs.
StepInput inputAt(std::int64_t step) {
  StepInput input;
  const double t = static_cast<double>(step) / 60;
  input.joints[Insertion] = 0.02 * std::min(t, 8.0);
  input.joints[Rotation] = 0.3 * t;
  input.joints[TipUpDown] = 0.4 * std::sin(t);
  input.buttons[HelixGrab] = step > 200 && step < 400;
  input.buttons[Insufflate] = 1;
  return input;
}

void step(TimedSimulation& simulation, Publishers& publishers, BagTarget& target, const StepInput& input) {
  target.time = ros::Time(0, 0) + ros::Duration().fromNSec(simulation.now());
  simulation.setInput(input);
  publishers.appliedInput(simulation);
  simulation.step();
  target.time = ros::Time(0, 0) + ros::Duration().fromNSec(simulation.now());
  publishers.stepResult(simulation, {});
}

// All topics of a session with a reset in it, which may set the time back, too.
void record(const std::string& file, bool keep_time = true) {
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  BagTarget target{bag, "/", [](const std::string&) { return true; }, ros::Time(1)};
  Publishers publishers{SinkSource(target), true};
  const SceneModel made = modelOfText(kScene, "test");
  TimedSimulation simulation(made, made.model->scene.seed, kOrigin, 1);
  target.time = ros::Time(5);
  publishers.announceModel(simulation);
  publishers.wholeState(simulation, {});
  for (int k = 0; k < kSteps; ++k) step(simulation, publishers, target, inputAt(k));
  simulation.replaceState(initialState(*made.model, 7));
  if (!keep_time) simulation.restartTime(kOrigin);
  target.time = ros::Time(0, 0) + ros::Duration().fromNSec(simulation.now());
  publishers.announceRun(simulation);
  publishers.wholeState(simulation, {});
  for (int k = 0; k < kStepsAfter; ++k) step(simulation, publishers, target, inputAt(k));
  publishers.wholeState(simulation, {});  // as the simulator does when it ends
}

// A copy without some topics, with inputs edited.
void copyBag(const std::string& from, const std::string& to, const std::function<bool(const std::string&)>& keeps,
             const Edit& edit = {}) {
  rosbag::Bag in(from, rosbag::bagmode::Read), out(to, rosbag::bagmode::Write);
  for (const rosbag::MessageInstance& message : rosbag::View(in)) {
    if (!keeps(message.getTopic())) continue;
    const auto input = message.instantiate<vibe_msgs::StepInput>();
    if (input && edit) {
      edit(*input);
      out.write(message.getTopic(), message.getTime(), *input);
    } else {
      out.write(message.getTopic(), message.getTime(), message);
    }
  }
}

bool isKept(const std::string& topic) {
  const RecordingRule* rule = recordingRule(topic, "", {"/"});
  return rule == nullptr || !rule->replayed;
}

class ReplayTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    whole() = ::testing::TempDir() + "vibe_replay_whole.bag";
    record(whole());
  }
  static void TearDownTestSuite() { std::remove(whole().c_str()); }
  static std::string& whole() {
    static std::string file;
    return file;
  }

  std::string file = ::testing::TempDir() + "vibe_replay_test.bag";
  std::string filled = ::testing::TempDir() + "vibe_replay_filled.bag";
  ~ReplayTest() override {
    std::remove(file.c_str());
    std::remove(filled.c_str());
  }

  ReplayResult replayOf(const std::string& bag) {
    const Recording recording(bag);
    Replay::Listener nobody;
    Replay replay(recording, nobody);
    while (!replay.done() && !replay.result().difference) replay.step();
    return replay.result();
  }

  ReplayResult replayEdited(const Edit& edit) {
    copyBag(whole(), file, isKept, edit);
    return replayOf(file);
  }
};

vibe_msgs::SolverStatistics statisticsOf(const TimedSimulation& simulation) {
  vibe_msgs::SolverStatistics statistics;
  statistics.header.stamp.fromNSec(static_cast<std::uint64_t>(simulation.now()));
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash(simulation.state())));
  statistics.state_hash = text;
  return statistics;
}

TEST_F(ReplayTest, EveryStepIsTheSameAlsoAfterAReset) {
  const ReplayResult result = replayOf(whole());
  EXPECT_FALSE(result.difference) << result.difference->what;
  EXPECT_EQ(result.same, static_cast<std::uint64_t>(kSteps + kStepsAfter));
  EXPECT_EQ(result.unchecked, 0U);
}

// In the simulator's sense some of these edits change nothing: a joint beyond its limit stays at the limit.
TEST_F(ReplayTest, AnySingleEditIsFoundWhereItWasMade) {
  const auto at = [](std::uint64_t step, std::uint32_t run, std::function<void(vibe_msgs::StepInput&)> change) {
    return [=](vibe_msgs::StepInput& input) {
      if (input.step == step && input.run == run) change(input);
    };
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::uint64_t step;
    std::uint32_t run;
    std::function<void(vibe_msgs::StepInput&)> change;
  };
  std::vector<Case> cases;
  for (int joint = 0; joint < kJointCount; ++joint)
    cases.push_back({40, 1, [joint](auto& input) { input.joints[joint] = std::nextafter(input.joints[joint], 1e9); }});
  for (int button = 0; button < kButtonCount; ++button)
    cases.push_back({20, 1, [button](auto& input) { input.buttons[button] ^= 1; }});
  cases.push_back({4, 2, [nan](auto& input) { input.joints[Rotation] = nan; }});
  cases.push_back({0, 1, [](auto& input) { input.joints[Insertion] = -1; }});  // at its limit already
  cases.push_back({5, 1, [](auto& input) { input.pull_particle = 3; }});
  cases.push_back({5, 1, [](auto& input) { input.pull_target.z = 1; }});  // of no particle
  cases.push_back({kStepsAfter - 1, 2, [](auto& input) { input.input_hash ^= 1; }});
  cases.push_back({77, 1, [](auto& input) { input.state_hash ^= 1; }});
  for (const Case& c : cases) {
    const ReplayResult result = replayEdited(at(c.step, c.run, c.change));
    ASSERT_TRUE(result.difference);
    EXPECT_EQ(result.difference->step, c.step);
    EXPECT_EQ(result.difference->run, c.run);
  }
}

TEST_F(ReplayTest, NamesInputSceneAndVersionAsCauses) {
  const auto result = replayEdited([](auto& input) { input.joints[Rotation] += input.step == 20 && input.run == 1; });
  expectMentions(result.difference->what, "input");
  expectMentions(result.difference->cause, "edited");
  EXPECT_NEAR(result.difference->time, 20 / 60.0, 1e-6);
  {
    rosbag::Bag in(whole(), rosbag::bagmode::Read), out(file, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in)) {
      const auto info = message.instantiate<vibe_msgs::SessionInfo>();
      if (info) info->scene += "# ";
      if (info)
        out.write(message.getTopic(), message.getTime(), *info);
      else if (isKept(message.getTopic()))
        out.write(message.getTopic(), message.getTime(), message);
    }
  }
  expectMentions(replayOf(file).difference->what, "scene");
}

TEST_F(ReplayTest, OfAnotherStateVersionIsNotChecked) {
  {
    rosbag::Bag in(whole(), rosbag::bagmode::Read), out(file, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in)) {
      const auto info = message.instantiate<vibe_msgs::SessionInfo>();
      const auto input = message.instantiate<vibe_msgs::StepInput>();
      if (info) info->state_version = 3;
      if (info)
        out.write(message.getTopic(), message.getTime(), *info);
      else if (isKept(message.getTopic()) && !(input && input->run > 1))
        out.write(message.getTopic(), message.getTime(), message);
    }
  }
  const ReplayResult result = replayOf(file);
  EXPECT_FALSE(result.difference);
  EXPECT_EQ(result.same, 0U);
  EXPECT_EQ(result.unchecked, static_cast<std::uint64_t>(kSteps));
  expectMentions(result.unchecked_why, "version 3");
}

TEST_F(ReplayTest, MissingStepsAreRefused) {
  copyBag(whole(), file, isKept, [](auto& input) { input.step += input.step == 50; });
  EXPECT_THROW(Recording{file}, Error);
}

TEST_F(ReplayTest, BeginsAtAnySnapshotAndIsTheSameFromThere) {
  const Recording recording(whole());
  Replay::Listener nobody;
  Replay replay(recording, nobody);
  const auto stepAt = [&](double time, bool exact) {
    replay.seek(time, exact);
    return replay.simulation().state().step;
  };
  EXPECT_EQ(stepAt(10.5, false), 600);
  EXPECT_EQ(stepAt(10.5, true), 630);
  EXPECT_EQ(stepAt(1, true), 60);
  EXPECT_EQ(replay.simulation().run(), 1U);
  EXPECT_EQ(stepAt(11.2, true), 11);  // of the second run: the reset took one stamp
  EXPECT_EQ(replay.simulation().run(), 2U);
  EXPECT_EQ(stepAt(10.2, true), 612);
  while (!replay.done()) replay.step();
  EXPECT_FALSE(replay.result().difference);
}

TEST_F(ReplayTest, AResetThatSetsTheTimeBackIsReplayedAndReached) {
  record(file, false);
  const ReplayResult result = replayOf(file);
  EXPECT_FALSE(result.difference) << result.difference->what;
  EXPECT_EQ(result.same, static_cast<std::uint64_t>(kSteps + kStepsAfter));
  const Recording recording(file);
  Replay::Listener nobody;
  Replay replay(recording, nobody);
  EXPECT_NEAR(replay.duration(), (kSteps + kStepsAfter - 1) / 60.0, 1e-3);
  replay.seek(1, true);
  EXPECT_EQ(replay.simulation().run(), 1U);
  replay.seek(kSteps / 60.0 + 0.2, true);
  EXPECT_EQ(replay.simulation().run(), 2U);
  EXPECT_NEAR(replay.time(), kSteps / 60.0 + 0.2, 0.02);
}

// The message after the last step has the hash of a state that no input carries.
TEST_F(ReplayTest, TheLastStateIsComparedAlsoWhereStampsComeTwice) {
  record(file, false);
  std::string right, other;
  {
    const Recording recording(file);
    Replay::Listener nobody;
    Replay replay(recording, nobody);
    while (replay.simulation().run() == 1 && replay.simulation().state().step < kStepsAfter) replay.step();
    const auto first = statisticsOf(replay.simulation());
    while (!replay.done()) replay.step();
    auto last = statisticsOf(replay.simulation());
    ASSERT_EQ(first.header.stamp, last.header.stamp);
    ASSERT_NE(first.state_hash, last.state_hash);
    rosbag::Bag bag(file, rosbag::bagmode::Append);
    bag.write("/solver_statistics", first.header.stamp, first);
    bag.write("/solver_statistics", last.header.stamp, last);
  }
  EXPECT_FALSE(replayOf(file).difference);
  record(file);
  {
    const Recording recording(file);
    Replay::Listener nobody;
    Replay replay(recording, nobody);
    while (!replay.done()) replay.step();
    auto wrong = statisticsOf(replay.simulation());
    wrong.state_hash[0] = wrong.state_hash[0] == '0' ? '1' : '0';
    rosbag::Bag bag(file, rosbag::bagmode::Append);
    bag.write("/solver_statistics", wrong.header.stamp, wrong);
  }
  EXPECT_TRUE(replayOf(file).difference);
}

TEST_F(ReplayTest, ALaterRunThatCannotBeRepeatedIsNotPassedOver) {
  EXPECT_EQ(Recording(whole()).lost(), "");
  copyBag(whole(), file, [](const std::string& topic) { return topic != "/snapshot"; });
  const Recording recording(file);
  EXPECT_EQ(recording.runs().size(), 1U);
  EXPECT_EQ(recording.stepsLeftOut(), 0U);
  expectMentions(recording.lost(), "30 steps could be repeated, first step 0 of run 2");
  copyBag(whole(), filled, isKept, [](auto& input) { input.run += input.run == 2; });
  expectMentions(Recording(filled).lost(), "run 3");
}

// The replay finds the cause before it fails on a snapshot of the other model.
TEST_F(ReplayTest, AnotherModelIsNamedAlsoWhereASnapshotDoesNotFitIt) {
  {
    rosbag::Bag in(whole(), rosbag::bagmode::Read), out(file, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in)) {
      const auto info = message.instantiate<vibe_msgs::SessionInfo>();
      if (!info) {
        out.write(message.getTopic(), message.getTime(), message);
        continue;
      }
      const std::size_t number = info->scene.find("particles: 400");
      ASSERT_NE(number, std::string::npos);
      info->scene.replace(number, 14, "particles: 420");
      info->scene_hash = hash(info->scene);
      out.write(message.getTopic(), message.getTime(), *info);
    }
  }
  const Recording recording(file);
  Replay::Listener nobody;
  Replay replay(recording, nobody);
  try {
    replay.seek(10.5, false);
    FAIL() << "a snapshot of another model was taken";
  } catch (const ReplayEnd& end) {
    expectMentions(end.difference.what, "model");
  }
}

TEST_F(ReplayTest, TopicsOfOthersAreNotThinned) {
  EXPECT_NE(recordingRule("/left/joint_states", "", {"/left/"}), nullptr);
  ASSERT_NE(recordingRule("/scope/contacts", "", {"/"}), nullptr);
  EXPECT_EQ(recordingRule("/scope/contacts", "", {"/"})->period, kNever);
  EXPECT_EQ(recordingRule("/scene", "", {"/"}), nullptr) << "kept whole";
  EXPECT_EQ(recordingRule("/arm/joint_states", "", {"/", "/left/"}), nullptr);
  EXPECT_EQ(recordingRule("/robot/step_result", "", {"/"}), nullptr);
  EXPECT_NE(recordingRule("/clock", "", {"/left/"}), nullptr);
  EXPECT_EQ(recordingRule("/left/clock", "", {"/"}), nullptr);
  EXPECT_NE(recordingRule("/robot/camera", "sensor_msgs/Image", {"/"}), nullptr);
}

TEST_F(ReplayTest, FillingAFullDiskIsAnError) {
  std::filesystem::create_symlink("/dev/full", filled + ".active");
  {
    const Recording recording(whole());
    std::string said;
    try {
      BagFiller filler(recording, filled);
      Replay replay(recording, filler);
      while (!replay.done()) replay.step();
      filler.finish(replay.simulation());
    } catch (const Error& error) {
      said = error.what();
    }
    EXPECT_TRUE(said.find("make room") != std::string::npos || said.find("cannot be written") != std::string::npos)
        << said;
  }
  std::filesystem::remove(filled + ".active");
}

// A recorder that starts in the middle gets a snapshot with the first input.
TEST_F(ReplayTest, ARecordingThatBeganLateBeginsAtItsFirstSnapshot) {
  copyBag(whole(), file, isKept, [](auto&) {});
  {
    rosbag::Bag in(file, rosbag::bagmode::Read), out(filled, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in, ros::Time(5 + 8)))
      out.write(message.getTopic(), message.getTime(), message);
    for (const rosbag::MessageInstance& message : rosbag::View(in, ros::TIME_MIN, ros::Time(5 + 8)))
      if (message.isType<vibe_msgs::SessionInfo>()) out.write(message.getTopic(), ros::Time(13), message);
  }
  const Recording recording(filled);
  EXPECT_NEAR(static_cast<double>(recording.stepsLeftOut()), 120, 1);
  const ReplayResult result = replayOf(filled);
  EXPECT_FALSE(result.difference) << result.difference->what;
  EXPECT_EQ(result.same, static_cast<std::uint64_t>(kSteps - 600 + kStepsAfter));
}

// Messages by topic, in order, without the numbers that a graph gives them.
std::map<std::string, std::vector<std::string>> messagesOf(const std::string& file) {
  std::map<std::string, std::vector<std::string>> messages;
  rosbag::Bag bag(file, rosbag::bagmode::Read);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream out(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                    static_cast<std::uint32_t>(bytes.size()));
    message.write(out);
    messages[message.getTopic()].push_back(bytes);
  }
  return messages;
}

TEST_F(ReplayTest, FillsInWhatWasLeftOutToTheBit) {
  copyBag(whole(), file, isKept);
  {
    const Recording recording(file);
    BagFiller filler(recording, filled);
    Replay replay(recording, filler);
    while (!replay.done()) replay.step();
    filler.finish(replay.simulation());
  }
  const auto before = messagesOf(whole()), thin = messagesOf(file), after = messagesOf(filled);
  EXPECT_LT(thin.size() + 10, before.size());
  for (const auto& [topic, messages] : before) {
    if (topic == "/clock") continue;  // whether there was one cannot be known without it
    ASSERT_EQ(after.count(topic), 1U) << topic;
    EXPECT_EQ(messages.size(), after.at(topic).size()) << topic;
    EXPECT_TRUE(messages == after.at(topic)) << topic;
  }
}

}  // namespace
}  // namespace vibe::sim::replay_test
