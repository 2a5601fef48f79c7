#include <gtest/gtest.h>

#include <dirent.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "camera/fake_rig.hpp"
#include "camera/host_time.hpp"
#include "camera/own_network.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vibe_vision/camera/capture.hpp"

namespace vibe::vision::aravis_source_test {

namespace {

const bool kHasOwnNetwork = enterOwnNetwork();  // before any thread starts

SourceOptions wide() {
  SourceOptions options;
  options.rate = 100;
  return options;
}

struct TruthRow {
  double stamp = 0;
  std::size_t picture = 0;
};

std::map<std::uint64_t, TruthRow> readTruth(const std::string& file) {
  std::map<std::uint64_t, TruthRow> rows;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "sequence,stamp,instrument,slide,rotation,along,lateral,x,y,velocity,visible");
  while (std::getline(stream, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    std::uint64_t sequence = 0;
    TruthRow row;
    std::string name;
    text >> sequence >> row.stamp >> name >> row.picture;
    EXPECT_EQ(name, "picture");
    rows[sequence] = row;
  }
  return rows;
}

int openFiles() {
  int count = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (::readdir(folder)) ++count;
  ::closedir(folder);
  return count;
}

int threads() {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) count += entry.exists() ? 1 : 0;
  return count;
}

}  // namespace

TEST(AravisSource, PixelsSequenceAndStampsAreThoseOfTheCamera) {
  FakeCameraOptions rig;
  rig.truth_file = "/tmp/vibe_aravis_truth_" + std::to_string(::getpid()) + ".csv";
  const auto ring = gradientRing();
  const auto camera = plugIn(rig, ring);
  const auto source = openSource("gige:127.0.0.1", wide());
  struct Seen {
    std::uint64_t sequence;
    double stamp, exposure, arrival;
    std::uint8_t first, last;
  };
  std::vector<Seen> seen;
  Frame frame;
  while (seen.size() < 250) {
    ASSERT_TRUE(readFrame(*source, frame)) << source->status();
    ASSERT_EQ(frame.image.width, 320);
    ASSERT_EQ(frame.image.height, 200);
    seen.push_back(
        {frame.sequence, frame.stamp, frame.exposure, frame.arrival, frame.image.row(0)[0], frame.image.row(199)[319]});
  }
  const auto truth = readTruth(rig.truth_file);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_TRUE(truth.count(seen[i].sequence)) << seen[i].sequence;
    const TruthRow& row = truth.at(seen[i].sequence);
    EXPECT_EQ(seen[i].first, ring->frames[row.picture].front());
    EXPECT_EQ(seen[i].last, ring->frames[row.picture].back());
    EXPECT_NEAR(seen[i].exposure, 1e-3, 1e-9);
    EXPECT_GT(seen[i].arrival, seen[i].stamp);
    if (i < 100) continue;
    EXPECT_GT(seen[i].stamp - row.stamp, -1e-4);
    EXPECT_LT(seen[i].stamp - row.stamp, 5e-3) << "arrived " << seen[i].arrival - row.stamp;
  }
  EXPECT_GT(seen.back().sequence, 65535U);  // the camera's numbers have wrapped on the way
  EXPECT_EQ(seen.back().sequence - seen.front().sequence + 1,
            source->statistics().frames + source->statistics().lost + source->statistics().incomplete);
  std::filesystem::remove(rig.truth_file);
}

TEST(AravisSource, ARegionIsThatPartOfTheSensor) {
  const auto ring = gradientRing(320, 200, 1);
  const auto camera = plugIn({}, ring);
  SourceOptions options = wide();
  options.roi_x = 40;
  options.roi_y = 30;
  options.roi_width = 100;
  options.roi_height = 50;
  const auto source = openSource("gige:127.0.0.1", options);
  Frame frame;
  ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  EXPECT_EQ(frame.image.width, 100);
  EXPECT_EQ(frame.image.height, 50);
  EXPECT_EQ(frame.offset_x, 40);
  EXPECT_EQ(frame.offset_y, 30);
  EXPECT_EQ(frame.sensor_width, 320);
  EXPECT_EQ(frame.sensor_height, 200);
  EXPECT_EQ(frame.image.row(49)[99], ring->frames[0][320 * (30 + 49) + 40 + 99]);
}

TEST(AravisSource, OtherPixelFormatsBecomeGrey) {
  const auto camera = plugIn({}, gradientRing(320, 200, 1));
  SourceOptions options = wide();
  options.pixel_format = "BayerRG8";  // the simulated camera sends the same bytes
  const auto source = openSource("gige:127.0.0.1", options);
  Frame frame;
  ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  EXPECT_NEAR(frame.image.row(20)[20], 20 + 60, 2);
}

TEST(AravisSource, ACameraThatIsUnpluggedComesBackAlone) {
  auto camera = plugIn();
  const auto source = openSource("gige:127.0.0.1", wide());
  Frame frame;
  ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  std::uint64_t last = frame.sequence;
  int files = 0, workers = 0;
  for (std::uint64_t round = 1; round <= 2; ++round) {
    camera.reset();
    bool is_gone = false;
    const double deadline = steadyTime() + kForever;
    while (!is_gone && steadyTime() < deadline) is_gone = source->read(frame, 0.05) == ReadResult::Gone;
    ASSERT_TRUE(is_gone);
    EXPECT_NE(source->status().find("check power"), std::string::npos) << source->status();
    camera = plugIn();
    ASSERT_TRUE(readFrame(*source, frame)) << source->status();
    EXPECT_EQ(source->statistics().reconnects, round);
    EXPECT_NE(source->status().find("320 x 200"), std::string::npos) << source->status();
    EXPECT_GT(frame.sequence, last);
    EXPECT_NEAR(frame.stamp, hostTime(), kForever);
    last = frame.sequence;
    if (round == 1) files = openFiles(), workers = threads();
  }
  frame = Frame();
  // what belonged to the camera that is gone may end a moment later
  const double deadline = steadyTime() + kForever;
  while ((openFiles() > files || threads() > workers) && steadyTime() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_LE(openFiles(), files);
  EXPECT_LE(threads(), workers);
}

TEST(AravisSource, ACameraThatIsMissingAtTheStartIsFoundLater) {
  std::unique_ptr<FakeCamera> camera;  // outlives the source, which says goodbye to it
  const auto source = openSource("gige:127.0.0.1", wide());
  Frame frame;
  EXPECT_EQ(source->read(frame, 0.01), ReadResult::Gone);
  EXPECT_NE(source->status().find("does not answer; check power"), std::string::npos) << source->status();
  camera = plugIn();
  EXPECT_TRUE(readFrame(*source, frame)) << source->status();
  EXPECT_EQ(source->statistics().reconnects, 0U);
}

TEST(AravisSource, TheFirstCameraIsFoundWithoutAName) {
  const auto camera = plugIn();
  const auto source = openSource("gige:", wide());
  Frame frame;
  EXPECT_TRUE(readFrame(*source, frame)) << source->status();
}

TEST(RetryTimer, LetsOneAttemptPerSecondThrough) {
  RetryTimer timer;
  EXPECT_TRUE(timer.wait(0));
  const double begin = steadyTime();
  EXPECT_FALSE(timer.wait(0.01));
  while (!timer.wait(0.1)) {
  }
  EXPECT_GE(steadyTime() - begin, 0.9);
}

TEST(AravisSource, LostPacketsAreToldCountedAndForgotten) {
  FakeCameraOptions rig;
  rig.lost_ratio = 0.05;
  auto camera = plugIn(rig, gradientRing(728, 544, 4));
  const auto source = openSource("gige:127.0.0.1", wide());
  Frame frame;
  ASSERT_TRUE(readUntil(*source, [&] { return source->statistics().incomplete > 100; })) << source->status();
  const long memory = residentMemory();
  EXPECT_NE(source->status().find("packets missing"), std::string::npos) << source->status();
  ASSERT_TRUE(readUntil(*source, [&] { return source->statistics().incomplete > 400; }));
  ASSERT_TRUE(readFrame(*source, frame));  // some are complete
  EXPECT_LT(residentMemory() - memory, 4 << 20);
  EXPECT_EQ(source->statistics().reconnects, 0U) << "the stream ran out of buffers";
  camera.reset();
  camera = plugIn();
  const std::uint64_t before = source->statistics().frames;
  ASSERT_TRUE(readUntil(*source, [&] { return source->statistics().frames > before + 200; }));
  EXPECT_EQ(source->status().find("packets missing"), std::string::npos) << source->status();
}

TEST(AravisSource, AWrongPixelFormatIsToldAndForgotten) {
  const auto camera = plugIn();
  const auto source = openSource("gige:127.0.0.1", wide());
  Frame frame;
  ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  camera->announceFormat(0x01080099);
  ASSERT_TRUE(readUntil(*source, [&] { return source->statistics().unreadable > 3; }));
  EXPECT_NE(source->status().find("0x01080099"), std::string::npos) << source->status();
  EXPECT_NE(source->status().find("set its PixelFormat"), std::string::npos) << source->status();
  camera->announceFormat(0x01080001);
  ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  ASSERT_TRUE(readUntil(*source, [&] { return source->status().find("320 x 200 at") < 200; })) << source->status();
}

TEST(AravisSource, AClockThatIsResetDoesNotSpoilTheStamps) {
  const auto camera = plugIn();
  const auto source = openSource("gige:127.0.0.1", wide());
  Frame frame;
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(readFrame(*source, frame));
  camera->resetClock();
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(readFrame(*source, frame));
    EXPECT_LT(std::abs(frame.arrival - frame.stamp), 2) << i;
  }
}

TEST(AravisSource, AClockOfUnixTimeIsTakenAtItsWord) {
  FakeCameraOptions rig;
  rig.clock_ahead = 0;
  rig.truth_file = "/tmp/vibe_aravis_ptp_" + std::to_string(::getpid()) + ".csv";
  const auto camera = plugIn(rig);
  SourceOptions options = wide();
  options.clock = CameraClock::Host;
  const auto source = openSource("gige:127.0.0.1", options);
  Frame frame;
  ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  EXPECT_NEAR(frame.stamp, readTruth(rig.truth_file).at(frame.sequence).stamp, 1e-5);
  std::filesystem::remove(rig.truth_file);
}

TEST(AravisSource, FramesThatAreHeldStayAsTheyAre) {
  const auto camera = plugIn({}, gradientRing(64, 8, 200));
  auto source = openSource("gige:127.0.0.1", wide());
  std::vector<Frame> held(40);  // more than the stream has buffers
  std::vector<int> grey;
  for (Frame& frame : held) {
    ASSERT_TRUE(readFrame(*source, frame)) << source->status();
    grey.push_back(frame.image.row(0)[0]);
  }
  for (int i = 0; i < 20; ++i) {
    Frame frame;
    ASSERT_TRUE(readFrame(*source, frame)) << source->status();
  }
  EXPECT_EQ(source->statistics().reconnects, 0U) << "the stream ran out of buffers";
  source.reset();  // frames may outlive their source
  for (std::size_t i = 0; i < held.size(); ++i) EXPECT_EQ(held[i].image.row(0)[0], grey[i]);
}

TEST(FakeCamera, ASecondOneAtTheSameAddressIsRefused) {
  const auto camera = plugIn();
  EXPECT_ERROR(FakeCamera(gradientRing(), {}), "is in use, perhaps by another fake camera");
}

TEST(FakeCamera, AnAddressOfAnotherComputerIsRefused) {
  FakeCameraOptions options;
  options.address = "192.0.2.1";
  EXPECT_THROW(FakeCamera(gradientRing(), options), Error);
}

}  // namespace vibe::vision::aravis_source_test
