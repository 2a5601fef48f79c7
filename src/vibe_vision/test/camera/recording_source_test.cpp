#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "camera/host_time.hpp"
#include "camera/picture_reader.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision::recording_source_test {
namespace fs = std::filesystem;

namespace {

class RecordingSourceTest : public ::testing::Test {
 protected:
  fs::path folder_ = fs::temp_directory_path() / ("vibe_recording_test_" + std::to_string(::getpid()));

  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  static cv::Mat picture(int k, int width = 64, int height = 48) {
    cv::Mat image(height, width, CV_8U);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(7 * k + x + 2 * y);
    }
    return image;
  }

  void writeImages(int count, int first = 0) {
    for (int k = first; k < first + count; ++k) cv::imwrite(path("frame_" + std::to_string(k) + ".png"), picture(k));
  }

  std::string writeVideo(int count, bool is_colour = false) {
    const std::string file = path("video.mkv");
    cv::VideoWriter writer(file, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 147, {64, 48}, is_colour);
    EXPECT_TRUE(writer.isOpened());
    for (int k = 0; k < count; ++k) writer.write(picture(k));
    return file;
  }

  void writeTable(const std::string& name, const std::string& text) { std::ofstream(path(name)) << text; }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string images() const { return "images:" + path("frame_*.png"); }

  static std::string errorOf(const std::string& address, const SourceOptions& options = {}) {
    return vibe::errorOf([&] { openSource(address, options); });
  }

  static bool isPicture(const Frame& frame, int k) {
    for (int y = 0; y < frame.image.height; ++y) {
      for (int x = 0; x < frame.image.width; ++x) {
        if (frame.image.row(y)[x] != static_cast<std::uint8_t>(7 * k + x + 2 * y)) return false;
      }
    }
    return true;
  }
};

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

}  // namespace

TEST_F(RecordingSourceTest, ImagesComeInTheOrderOfTheirNumbersWithTheirStamps) {
  writeImages(12);  // frame_2 is before frame_10
  std::string table = "sequence,stamp,exposure\n";
  for (int k = 0; k < 12; ++k) table += std::to_string(100 + k) + "," + std::to_string(5 + 0.01 * k) + ",0.002\n";
  writeTable("frames.csv", table);
  const auto source = openSource(images(), {});
  Frame frame;
  for (int k = 0; k < 12; ++k) {
    ASSERT_EQ(source->read(frame, 1), ReadResult::Frame);
    EXPECT_TRUE(isPicture(frame, k));
    EXPECT_EQ(frame.sequence, 100U + static_cast<unsigned>(k));
    EXPECT_NEAR(frame.stamp, 5 + 0.01 * k, 1e-9);
    EXPECT_NEAR(frame.exposure, 0.002, 1e-12);
  }
  EXPECT_EQ(source->read(frame, 1), ReadResult::End);
  EXPECT_EQ(source->statistics().frames, 12U);
}

TEST_F(RecordingSourceTest, WithoutATableTheRateGivesTheStamps) {
  writeImages(3);
  SourceOptions options;
  options.rate = 50;
  options.exposure = 0.004;
  options.roi_x = 10;
  const auto source = openSource(images(), options);
  Frame frame;
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(source->read(frame, 1), ReadResult::Frame);
    EXPECT_NEAR(frame.stamp, 0.02 * k, 1e-12);
    EXPECT_EQ(frame.exposure, 0.004);
    EXPECT_EQ(frame.offset_x, 10);
    EXPECT_EQ(frame.sensor_width, 74);
  }
}

TEST_F(RecordingSourceTest, AVideoWithoutLossIsBitExact) {
  const std::string file = writeVideo(20);
  std::string table = "stamp\n";
  for (int k = 0; k < 20; ++k) table += std::to_string(1000 + k) + "\n";
  writeTable("video.mkv.csv", table);
  const auto source = openSource("video:" + file, {});
  Frame frame;
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(source->read(frame, 1), ReadResult::Frame);
    EXPECT_TRUE(isPicture(frame, k));
    EXPECT_EQ(frame.stamp, 1000 + k);
  }
  EXPECT_EQ(source->read(frame, 1), ReadResult::End);
}

TEST_F(RecordingSourceTest, APacedRecordingTakesItsTimeAndIsStampedNow) {
  writeImages(20);
  SourceOptions options;
  options.rate = 50;
  options.paced = true;
  const auto source = openSource(images(), options);
  const double begin = hostTime();
  Frame frame;
  for (int k = 0; k < 20;) {
    const ReadResult result = source->read(frame, 0.005);
    ASSERT_NE(result, ReadResult::End);
    if (result != ReadResult::Frame) continue;
    EXPECT_GE(frame.arrival, frame.stamp + frame.exposure / 2);
    EXPECT_GE(frame.stamp, begin + 0.02 * k);
    ++k;
  }
  EXPECT_GE(hostTime() - begin, 19 * 0.02);
}

TEST_F(RecordingSourceTest, ALoopContinuesStampsAndSequence) {
  writeImages(3);
  SourceOptions options;
  options.rate = 50;
  options.loop = true;
  const auto source = openSource(images(), options);
  Frame frame;
  for (int k = 0; k < 10; ++k) {
    ASSERT_EQ(source->read(frame, 1), ReadResult::Frame);
    EXPECT_TRUE(isPicture(frame, k % 3));
    EXPECT_EQ(frame.sequence, static_cast<unsigned>(k));
    EXPECT_NEAR(frame.stamp, 0.02 * k, 1e-9);
  }
  EXPECT_EQ(source->statistics().lost, 0U);
}

TEST_F(RecordingSourceTest, GapsOfTheSequenceAreLostFrames) {
  writeImages(3);
  writeTable("frames.csv", "sequence,stamp\n4,1.0\n5,1.1\n9,1.5\n");
  const auto source = openSource(images(), {});
  Frame frame;
  while (source->read(frame, 1) == ReadResult::Frame) {
  }
  EXPECT_EQ(source->statistics().lost, 3U);
}

TEST_F(RecordingSourceTest, ImagesOfAnotherSizeAreLeftOutAndTold) {
  writeImages(5);
  cv::imwrite(path("frame_2.png"), picture(2, 32, 48));
  const auto source = openSource(images(), {});
  Frame frame;
  std::vector<std::uint64_t> seen;
  while (source->read(frame, 1) == ReadResult::Frame) {
    EXPECT_EQ(frame.image.width, 64);
    seen.push_back(frame.sequence);
  }
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{0, 1, 3, 4}));
  EXPECT_EQ(source->statistics().unreadable, 1U);
  EXPECT_EQ(source->statistics().lost, 0U);
  EXPECT_SAYS(source->status(), "32 x 48 pixels, but the first has 64 x 48");
}

TEST_F(RecordingSourceTest, ADamagedImageIsLeftOutAndTold) {
  writeImages(4);
  std::ofstream(path("frame_1.png")) << "this is no image";
  fs::resize_file(path("frame_2.png"), 20);
  const auto source = openSource(images(), {});
  Frame frame;
  int count = 0;
  while (source->read(frame, 1) == ReadResult::Frame) ++count;
  EXPECT_EQ(count, 2);
  EXPECT_EQ(source->statistics().unreadable, 2U);
  EXPECT_SAYS(source->status(), "frame_2.png cannot be read as an image");
}

TEST_F(RecordingSourceTest, ALoopOfNothingReadableEnds) {
  std::ofstream(path("frame_1.png")) << "this is no image";
  SourceOptions options;
  options.loop = true;
  const auto source = openSource(images(), options);
  Frame frame;
  EXPECT_EQ(source->read(frame, 1), ReadResult::End);
}

TEST_F(RecordingSourceTest, SixteenBitsAndColourBecomeGrey) {
  cv::imwrite(path("frame_0.png"), cv::Mat(4, 4, CV_16U, cv::Scalar(0xABFF)));
  cv::imwrite(path("frame_1.png"), cv::Mat(4, 4, CV_8UC3, cv::Scalar(0, 0, 200)));
  const auto source = openSource(images(), {});
  Frame frame;
  ASSERT_EQ(source->read(frame, 1), ReadResult::Frame);
  EXPECT_EQ(frame.image.row(2)[2], 0xAB);
  ASSERT_EQ(source->read(frame, 1), ReadResult::Frame);
  EXPECT_EQ(frame.image.row(2)[2], 60);
}

TEST_F(RecordingSourceTest, ATruncatedVideoEndsWithAMessage) {
  const std::string file = writeVideo(60);
  fs::resize_file(file, fs::file_size(file) / 2);
  const auto source = openSource("video:" + file, {});
  Frame frame;
  int count = 0;
  while (source->read(frame, 1) == ReadResult::Frame) ++count;
  EXPECT_GT(count, 5);
  EXPECT_LT(count, 60);
  EXPECT_SAYS(source->status(), "truncated");
}

TEST_F(RecordingSourceTest, WhatIsNoVideoIsRefused) {
  std::ofstream(path("text.mkv")) << "this is no video";
  EXPECT_SAYS(errorOf("video:" + path("text.mkv")), "cannot read it as a video");
  EXPECT_SAYS(errorOf("video:" + path("absent.mkv")), "there is no such file");
  EXPECT_SAYS(errorOf("video:" + folder_.string()), "is not a file");
}

TEST_F(RecordingSourceTest, APatternWithoutAMatchIsRefused) {
  EXPECT_SAYS(errorOf(images()), "no file matches");
}

TEST_F(RecordingSourceTest, ATableThatDoesNotFitIsRefused) {
  writeImages(3);
  const auto errorWith = [this](const std::string& table) {
    writeTable("frames.csv", table);
    return errorOf(images());
  };
  EXPECT_EQ(errorWith("stamp\n1\n2\n3\n"), "no error");
  EXPECT_SAYS(errorWith("stamp\n1\n2\n3\n4\n5\n6\n"), "has 6 rows, but images:");
  EXPECT_SAYS(errorWith("stamp\n1\n"), "one row per frame");
  EXPECT_SAYS(errorWith("stamp\n1\n2\n3\n4\n"), "has 4 rows");
  EXPECT_SAYS(errorWith("stamp\n"), "has 0 rows");
  EXPECT_SAYS(errorWith(""), "no column is called stamp");
  EXPECT_SAYS(errorWith("time\n1\n2\n3\n"), "frames.csv:1: no column is called stamp");
  EXPECT_SAYS(errorWith("stamp\n1\nnan\n3\n"), "frames.csv:3: stamp is \"nan\"");
  EXPECT_SAYS(errorWith("stamp,exposure\n1,0.001\n2,-1\n3,0.001\n"), "exposure is \"-1\"");
  EXPECT_SAYS(errorWith("stamp\n1\n2\n2\n"), "frames.csv:4: stamp does not increase");
  EXPECT_SAYS(errorWith("sequence,stamp\n1,1\n1,2\n2,3\n"), "sequence does not increase");
  EXPECT_SAYS(errorWith("sequence,stamp\n1,1\n2\n3,3\n"), "1 values, but the first line names 2 columns");
  EXPECT_SAYS(errorWith("sequence,stamp\n1.5,1\n2,2\n3,3\n"), "must be a whole number");
}

TEST_F(RecordingSourceTest, ATableOfAVideoThatDoesNotFitIsRefused) {
  const std::string file = writeVideo(20);
  writeTable("video.mkv.csv", "stamp\n1\n2\n3\n");
  EXPECT_SAYS(errorOf("video:" + file), "has 3 rows, but video:");
}

TEST(OpenSource, AnAddressThatIsNotUnderstoodIsRefused) {
  for (const char* address : {"", "webcam", "gige", "video:", "v4l2:", "images:", "usb:1"})
    EXPECT_ERROR(openSource(address, {}), "is not understood; write v4l2:/dev/video0, gige:ADDRESS");
}

TEST(OpenSource, OptionsOutOfRangeAreRefused) {
  const auto refuses = [](auto change) {
    SourceOptions options;
    change(options);
    EXPECT_THROW(openSource("gige:", options), Error);
  };
  refuses([](SourceOptions& o) { o.exposure = 0; });
  refuses([](SourceOptions& o) { o.exposure = std::nan(""); });
  refuses([](SourceOptions& o) { o.rate = -1; });
  refuses([](SourceOptions& o) { o.roi_x = -1; });
  refuses([](SourceOptions& o) { o.packet_size = 100; });
  refuses([](SourceOptions& o) { o.gain = -2; });
  refuses([](SourceOptions& o) { o.realtime_priority = 100; });
}

}  // namespace vibe::vision::recording_source_test
