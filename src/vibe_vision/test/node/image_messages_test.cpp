#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/weak_ptr.hpp>

#include <numeric>
#include <opencv2/imgcodecs.hpp>

#include "node/node_test_support.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vision_messages.hpp"

namespace vibe::vision::image_messages_test {
namespace {

namespace encodings = sensor_msgs::image_encodings;

sensor_msgs::ImagePtr image(const std::string& encoding, std::uint32_t bytes_per_pixel) {
  sensor_msgs::ImagePtr message(new sensor_msgs::Image);
  message->header.stamp = ros::Time(1000, 500);
  message->header.seq = 5;
  message->encoding = encoding;
  message->width = 8;
  message->height = 4;
  message->step = 8 * bytes_per_pixel + 2;
  message->data.resize(message->step * 4);
  std::iota(message->data.begin(), message->data.end(), std::uint8_t{0});
  return message;
}

/// Of a camera that nothing is known about.
SampleDepth& depth() {
  static SampleDepth unknown;
  return unknown = {};
}

std::string refusalOf(const sensor_msgs::ImagePtr& message, const sensor_msgs::CameraInfo& info) {
  return errorOf([&] { makeFrame(message, info, 0.001, false, depth()); });
}

TEST(ImageMessages, GreyImagesAreSharedNotCopied) {
  sensor_msgs::CameraInfo info;
  info.width = 728;
  info.height = 544;
  info.roi.x_offset = 40;
  info.roi.y_offset = 30;
  info.roi.width = 8;
  info.roi.height = 4;
  sensor_msgs::ImagePtr message = image(encodings::MONO8, 1);
  const std::uint8_t* pixels = message->data.data();
  const boost::weak_ptr<sensor_msgs::Image> watch = message;
  Frame frame = makeFrame(message, info, 0.001, false, depth());
  EXPECT_EQ(frame.image.data, pixels);
  message.reset();
  EXPECT_FALSE(watch.expired());  // the frame keeps it
  EXPECT_EQ(frame.image.width, 8);
  EXPECT_EQ(frame.image.height, 4);
  EXPECT_EQ(frame.image.stride, 10);
  EXPECT_EQ(frame.offset_x, 40);
  EXPECT_EQ(frame.offset_y, 30);
  EXPECT_EQ(frame.sensor_width, 728);
  EXPECT_EQ(frame.sensor_height, 544);
  EXPECT_EQ(frame.sequence, 5u);
  EXPECT_EQ(frame.exposure, 0.001);
  EXPECT_DOUBLE_EQ(frame.stamp, 1000.0000005);
  frame = Frame();
  EXPECT_TRUE(watch.expired());
}

TEST(ImageMessages, StampsOfTheStartAreMovedToTheMiddle) {
  EXPECT_NEAR(makeFrame(image(encodings::MONO8, 1), {}, 0.004, true, depth()).stamp, 1000.0020005, 1e-9);
}

TEST(ImageMessages, WithoutASizeInCameraInfoTheImageIsTheSensor) {
  const Frame frame = makeFrame(image(encodings::MONO8, 1), {}, 0.001, false, depth());
  EXPECT_EQ(frame.sensor_width, 8);
  EXPECT_EQ(frame.sensor_height, 4);
  EXPECT_EQ(frame.offset_x, 0);
}

TEST(ImageMessages, ColourBecomesGrey) {
  const sensor_msgs::ImagePtr message = image(encodings::BGR8, 3);
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t x = 0; x < 8; ++x)
      for (std::size_t c = 0; c < 3; ++c) message->data[y * message->step + 3 * x + c] = static_cast<std::uint8_t>(x);
  const Frame frame = makeFrame(message, {}, 0.001, false, depth());
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(frame.image.row(y)[x], x);
}

/// A camera of 10 or 12 bits fills the lower ones; what one image has shown holds for darker ones after it.
TEST(ImageMessages, SixteenBitsAreThoseThatTheCameraUses) {
  for (const int bits : {10, 12, 16}) {
    const sensor_msgs::ImagePtr message = image(encodings::MONO16, 2);
    const auto fill = [&](int grey) {
      for (std::size_t i = 0; i + 1 < message->data.size(); i += 2) {
        const int value = (grey << (bits - 8)) + 1;
        message->data[i] = static_cast<std::uint8_t>(value),
        message->data[i + 1] = static_cast<std::uint8_t>(value >> 8);
      }
    };
    SampleDepth learnt;
    for (const int grey : {200, 3}) {
      fill(grey);
      EXPECT_EQ(makeFrame(message, {}, 0.001, false, learnt).image.row(2)[3], grey) << bits;
      EXPECT_EQ(learnt.bits, bits);
    }
  }
}

TEST(ImageMessages, CompressedImagesAreDecoded) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = ros::Time(7, 5);
  message.format = "mono8; png compressed";
  const cv::Mat pixels = (cv::Mat_<std::uint8_t>(2, 3) << 1, 2, 3, 4, 5, 250);
  cv::imencode(".png", pixels, message.data);
  const sensor_msgs::ImagePtr image = makeImage(message);
  EXPECT_EQ(image->header.stamp, ros::Time(7, 5));
  EXPECT_EQ(image->encoding, "mono8");
  EXPECT_EQ(image->data, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 250}));
  message.data.resize(message.data.size() / 4);
  EXPECT_NE(errorOf([&] { makeImage(message); }).find("'mono8; png compressed' cannot be decoded"), std::string::npos);
}

TEST(ImageMessages, UnusableImagesAreNamed) {
  sensor_msgs::CameraInfo info;
  sensor_msgs::ImagePtr message = image(encodings::MONO8, 1);
  EXPECT_EQ(refusalOf(message, info), "no error");
  message->header.stamp = ros::Time();
  EXPECT_NE(refusalOf(message, info).find("stamp 0"), std::string::npos);
  message = image(encodings::MONO8, 1);
  message->data.resize(20);
  EXPECT_NE(refusalOf(message, info).find("has only 20 bytes"), std::string::npos);
  message = image(encodings::MONO8, 1);
  message->step = 4;
  EXPECT_NE(refusalOf(message, info).find("in rows of 4"), std::string::npos);
  message = image(encodings::MONO8, 1);
  message->width = 0;
  EXPECT_NE(refusalOf(message, info).find("is empty"), std::string::npos);
  message = image("purple13", 1);
  EXPECT_NE(refusalOf(message, info).find("'purple13'"), std::string::npos);
  message = image(encodings::BGR8, 1);  // rows too short for three bytes per pixel
  EXPECT_NE(refusalOf(message, info), "no error");
  message = image(encodings::MONO8, 1);
  info.binning_x = 2;
  EXPECT_NE(refusalOf(message, info).find("binned"), std::string::npos);
  info.binning_x = 0;
  info.roi.width = 9;
  EXPECT_NE(refusalOf(message, info).find("region of interest"), std::string::npos);
}

TEST(ImageMessages, CameraInfoHasTheCalibrationAndTheRegion) {
  const CameraModel camera = twoInstruments().camera;
  Frame frame;
  frame.stamp = 1000.5;
  frame.image.width = 728;
  frame.image.height = 260;
  frame.offset_y = 100;
  const sensor_msgs::CameraInfo info = makeCameraInfo(camera, frame, "optical");
  EXPECT_EQ(info.header.stamp, ros::Time(1000, 500000000));
  EXPECT_EQ(info.header.frame_id, "optical");
  EXPECT_EQ(info.width, 728u);
  EXPECT_EQ(info.height, 544u);
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.D, (std::vector<double>{0.06, -0.01, 0.001, 0.002, 0.003}));
  EXPECT_EQ(info.K[0], 4600);
  EXPECT_EQ(info.K[2], 361);
  EXPECT_EQ(info.K[4], 4601);
  EXPECT_EQ(info.K[5], 274);
  EXPECT_EQ(info.P[0], 4600);
  EXPECT_EQ(info.P[6], 274);
  EXPECT_EQ(info.roi.y_offset, 100u);
  EXPECT_EQ(info.roi.width, 728u);
  EXPECT_EQ(info.roi.height, 260u);
  frame.image.height = 544;
  EXPECT_EQ(makeCameraInfo(camera, frame, "optical").roi.width, 0u);  // the whole image
}

TEST(ImageMessages, AnImageMessageAndAFrameAreTheSame) {
  const Frame frame = makeFrame(image(encodings::MONO8, 1), {}, 0.001, false, depth());
  const sensor_msgs::ImagePtr message = makeImage(frame, "optical");
  EXPECT_EQ(message->step, 8u);
  EXPECT_EQ(message->encoding, "mono8");
  const Frame again = makeFrame(message, {}, 0.001, false, depth());
  EXPECT_EQ(again.stamp, frame.stamp);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(again.image.row(y)[x], frame.image.row(y)[x]);
}

}  // namespace
}  // namespace vibe::vision::image_messages_test
