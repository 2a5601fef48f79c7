#include "video_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <opencv2/core.hpp>

namespace vibe::vision::video_file_test {
namespace {

namespace fs = std::filesystem;
constexpr int kFrames = 12;

class Video : public ::testing::Test {
 protected:
  Video() {
    std::string name = (fs::temp_directory_path() / "vibe_video_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    file_ = folder_ / "video.mkv";
  }
  ~Video() override { fs::remove_all(folder_); }

  /// A video of noise, 50 kB a frame, which is not finished.
  std::unique_ptr<VideoFile> begun() const {
    auto video = std::make_unique<VideoFile>(file_, "FFV1", 25, cv::Size(256, 192), false);
    for (int k = 0; k < kFrames; ++k) video->add(frame(k));
    return video;
  }
  static cv::Mat frame(int number) {
    cv::Mat picture(192, 256, CV_8UC1);
    cv::RNG(static_cast<std::uint64_t>(number) + 1).fill(picture, cv::RNG::UNIFORM, 0, 256);
    return picture;
  }
  long files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_, file_;
};

TEST_F(Video, HasItsNameWhenItIsWhole) {
  const auto video = begun();
  EXPECT_FALSE(fs::exists(file_));
  video->finish();
  EXPECT_EQ(files(), 1);
  cv::VideoCapture reader(file_.string());
  cv::Mat found, grey;
  for (int k = 0; k < kFrames; ++k) {
    ASSERT_TRUE(reader.read(found));
    cv::extractChannel(found, grey, 0);
    EXPECT_EQ(cv::norm(grey, frame(k), cv::NORM_INF), 0) << k;
  }
  EXPECT_FALSE(reader.read(found));
}

TEST_F(Video, ThatIsGivenUpLeavesWhatWasThere) {
  std::ofstream(file_) << "what was there";
  begun().reset();
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(fs::file_size(file_), 14U);
}

TEST_F(Video, ForWhichThereIsNoRoomIsAnError) {
  struct rlimit before {};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit little { 100'000, before.rlim_max };
  ::setrlimit(RLIMIT_FSIZE, &little);
  auto video = begun();
  EXPECT_THROW(video->finish(), Error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  video.reset();
  EXPECT_EQ(files(), 0);
}

TEST_F(Video, ThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(VideoFile(folder_ / "absent" / "video.mkv", "FFV1", 25, cv::Size(256, 192), false), Error);
  EXPECT_THROW(VideoFile(folder_ / "video.txt", "FFV1", 25, cv::Size(256, 192), false), Error);
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace vibe::vision::video_file_test
