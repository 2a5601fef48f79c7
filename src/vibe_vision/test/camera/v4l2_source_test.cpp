#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include <opencv2/videoio.hpp>

#include "camera/host_time.hpp"
#include "camera/sources.hpp"

namespace vibe::vision::v4l2_source_test {

namespace {

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

std::string statusOf(const std::string& device) {
  const auto source = openSource("v4l2:" + device, {});
  Frame frame;
  EXPECT_EQ(source->read(frame, 0), ReadResult::Gone);
  return source->status();
}

int codeOf(const char* letters) {
  return cv::VideoWriter::fourcc(letters[0], letters[1], letters[2], letters[3]);
}

}  // namespace

TEST(V4l2Source, AnAbsentCameraIsTold) {
  EXPECT_SAYS(statusOf("/dev/video_absent"), "/dev/video_absent: no such camera; plug it in");
}

TEST(V4l2Source, AFileThatIsNoCameraIsTold) {
  const std::string file = "/tmp/vibe_v4l2_test_" + std::to_string(::getpid());
  std::ofstream(file) << "no camera";
  EXPECT_SAYS(statusOf(file), "is not a V4L2 device");
  std::remove(file.c_str());
  EXPECT_SAYS(statusOf("/dev/null"), "is not a V4L2 device");
}

TEST(V4l2SourceDeathTest, MissingPermissionIsTold) {
  const std::string file = "/tmp/vibe_v4l2_secret_" + std::to_string(::getpid());
  std::ofstream(file) << "secret";
  ASSERT_EQ(::chmod(file.c_str(), 0), 0);
  const auto look = [&file] {
    if (::geteuid() == 0 && ::seteuid(65534) != 0) ::_exit(2);
    std::fprintf(stderr, "%s", v4l2Obstacle(file).c_str());
    ::_exit(0);
  };
  EXPECT_EXIT(look(), ::testing::ExitedWithCode(0), "permission denied; add the user to the group video");
  std::remove(file.c_str());
}

TEST(V4l2Source, AnAbsentCameraIsLookedForOncePerSecond) {
  const auto source = openSource("v4l2:/dev/video_absent", {});
  Frame frame;
  EXPECT_EQ(source->read(frame, 0), ReadResult::Gone);
  const double begin = steadyTime();
  int reads = 0;
  while (steadyTime() - begin < 0.3) {
    EXPECT_EQ(source->read(frame, 0.1), ReadResult::Gone);
    ++reads;
  }
  EXPECT_LE(reads, 4);  // each waits for its timeout: nobody spins
}

TEST(V4l2Source, KernelStampsAreMappedToUnixTime) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const double monotonic = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  EXPECT_NEAR(unixFromMonotonic(monotonic - 0.5), hostTime() - 0.5, 0.1);
}

TEST(V4l2Source, FormatsOfTheDriverAreKnown) {
  EXPECT_EQ(v4l2Format(codeOf("GREY")), PixelFormat::Mono8);
  EXPECT_EQ(v4l2Format(codeOf("YUYV")), PixelFormat::YUYV);
  EXPECT_EQ(v4l2Format(codeOf("Y12 ")), PixelFormat::Mono12);
  EXPECT_FALSE(isReadable(v4l2Format(codeOf("MJPG"))));  // OpenCV decodes it
}

}  // namespace vibe::vision::v4l2_source_test
