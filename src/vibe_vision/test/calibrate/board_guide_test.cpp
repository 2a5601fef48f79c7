#include "vibe_vision/calibrate/board_guide.hpp"

#include <gtest/gtest.h>

#include <functional>

#include <opencv2/imgproc.hpp>

#include "calibrate/rendered_board.hpp"

namespace vibe::vision::board_guide_test {
namespace {

constexpr double kDistance = 0.2;  // [m]

/// A board before the camera, turned about an axis of the image, beside its middle.
Eigen::Isometry3d poseAt(double x, double y, double tilt, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX()) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(x, y, kDistance));
  pose.rotate(Eigen::AngleAxisd(tilt, axis));
  pose.translate(Eigen::Vector3d(-(kBoard.columns - 1) * kBoard.square / 2, -(kBoard.rows - 1) * kBoard.square / 2, 0));
  return pose;
}

/// What is said of a picture that something has spoilt.
std::string problemOf(const std::function<void(cv::Mat&)>& spoil) {
  const CameraModel camera = smallCamera();
  const RenderedBoard board(camera, kBoard);
  std::vector<std::uint8_t> pixels = board.draw(poseAt(0, 0, 0.1), 0.5, 1);
  cv::Mat grey(camera.height, camera.width, CV_8U, pixels.data());
  spoil(grey);
  return BoardGuide(kBoard, camera.fx, camera.width, camera.height).look(board.view(pixels)).problem;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(BoardGuide, SaysWhatSpoilsAPicture) {
  EXPECT_EQ(problemOf([](cv::Mat&) {}), "");
  const std::string blurred = problemOf([](cv::Mat& m) { cv::GaussianBlur(m, m, {}, 3.5); });
  EXPECT_TRUE(has(blurred, "blurred")) << blurred;
  const std::string bright = problemOf([](cv::Mat& m) { m.convertTo(m, -1, 2); });
  EXPECT_TRUE(has(bright, "over-exposed")) << bright;
  const std::string white = problemOf([](cv::Mat& m) { m.convertTo(m, -1, 9); });
  EXPECT_TRUE(has(white, "over-exposed")) << white;
  const std::string dark = problemOf([](cv::Mat& m) { m.convertTo(m, -1, 0.15); });
  EXPECT_TRUE(has(dark, "too dark")) << dark;
  const std::string covered = problemOf([](cv::Mat& m) { m(cv::Rect(150, 100, 60, 60)) = 180; });
  EXPECT_TRUE(has(covered, "no whole chessboard")) << covered;
}

TEST(BoardGuide, SaysWhichPicturesAreMissing) {
  const CameraModel camera = smallCamera();
  CameraModel small = camera;  // no pictures are drawn
  small.width = small.height = 1;
  const RenderedBoard board(small, kBoard);
  BoardGuide guide(kBoard, camera.fx, camera.width, camera.height);
  EXPECT_EQ(
      guide.missing(),
      "8 more pictures; tilts by 20 to 40 deg with its left, right, upper and lower side farther away; the board "
      "at the upper left, upper, upper right, left, middle, right, lower left, lower and lower right of the image");
  const auto take = [&](const Eigen::Isometry3d& pose) {
    EXPECT_TRUE(guide.isNew(board.corners(pose)));
    guide.take(board.corners(pose));
    EXPECT_FALSE(guide.isNew(board.corners(pose)));
  };
  take(poseAt(0, 0, 0.5));  // about x to the right: the lower side of the image goes away
  EXPECT_TRUE(has(guide.missing(), "7 more pictures; tilts by 20 to 40 deg with its left, right and upper side"));
  EXPECT_FALSE(has(guide.missing(), "middle"));
  take(poseAt(0, 0, -0.5));
  take(poseAt(0, 0, 0.5, Eigen::Vector3d::UnitY()));  // about y, which points down: the right side comes nearer
  EXPECT_TRUE(has(guide.missing(), "with its right side")) << guide.missing();
  take(poseAt(0, 0, -0.5, Eigen::Vector3d::UnitY()));
  EXPECT_FALSE(has(guide.missing(), "tilts")) << guide.missing();
  for (const double y : {-0.019, 0.019})
    for (const double x : {-0.024, 0.0}) take(poseAt(x, y, 0.1));
  EXPECT_EQ(guide.missing(), "the board at the upper right, right and lower right of the image");
  for (const double y : {-0.019, 0.019}) take(poseAt(0.024, y, 0.1));
  EXPECT_EQ(guide.missing(), "");
}

}  // namespace
}  // namespace vibe::vision::board_guide_test
