#include "vibe_vision/image/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace vibe::vision::camera_model_test {
namespace {

CameraModel cameraWith(const std::array<double, 5>& distortion) {
  CameraModel camera;
  camera.width = 728;
  camera.height = 544;
  camera.fx = 900;
  camera.fy = 910;
  camera.cx = 361.4;
  camera.cy = 274.2;
  camera.distortion = distortion;
  return camera;
}

/// Barrel, pincushion, a lens that is not centred, and all coefficients.
const std::vector<std::array<double, 5>> kLenses = {
    {-0.3, 0, 0, 0, 0}, {0.35, 0, 0, 0, 0}, {0.06, 0, 3e-3, -4e-3, 0}, {-0.25, 0.12, 1e-3, 2e-3, -0.03}};

TEST(CameraModel, UndistortIsTheInverseOfDistortInTheWholeImage) {
  for (const auto& lens : kLenses) {
    const CameraModel camera = cameraWith(lens);
    for (int y = 0; y < camera.height; y += 17)
      for (int x = 0; x < camera.width; x += 17) {
        const Eigen::Vector2d pixel(x, y), ideal = undistort(camera, pixel);
        EXPECT_LT((distort(camera, ideal) - pixel).norm(), 1e-9) << x << ' ' << y;
        EXPECT_LT((undistort(camera, distort(camera, pixel)) - pixel).norm(), 1e-8) << x << ' ' << y;
      }
    // The lens does something.
    EXPECT_GT((undistort(camera, {0, 0}) - Eigen::Vector2d(0, 0)).norm(), 1);
  }
}

TEST(CameraModel, ProjectsAsOpenCvDoes) {
  for (const auto& lens : kLenses) {
    const CameraModel camera = cameraWith(lens);
    const cv::Mat matrix = (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Mat coefficients(1, 5, CV_64F, const_cast<double*>(lens.data()));
    std::vector<cv::Point3d> points;
    for (double x = -0.35; x <= 0.35; x += 0.07)
      for (double y = -0.25; y <= 0.25; y += 0.05) points.emplace_back(x, y, 0.9 + 0.2 * x - 0.1 * y);
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), matrix, coefficients, pixels);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d pixel = project(camera, {points[i].x, points[i].y, points[i].z});
      EXPECT_NEAR(pixel.x(), pixels[i].x, 1e-9);
      EXPECT_NEAR(pixel.y(), pixels[i].y, 1e-9);
    }
  }
}

TEST(CameraModel, WithoutDistortionPixelsStay) {
  const CameraModel camera = cameraWith({});
  EXPECT_FALSE(camera.isDistorted());
  EXPECT_EQ(undistort(camera, {3.25, 500.5}), Eigen::Vector2d(3.25, 500.5));
  EXPECT_EQ(distort(camera, {3.25, 500.5}), Eigen::Vector2d(3.25, 500.5));
  EXPECT_TRUE(cameraWith({0, 0, 0, 1e-4, 0}).isDistorted());
}

TEST(CameraModel, NoAnswerWhereTheLensCannotBeInverted) {
  // r (1 - 0.3 r^2) has its maximum 0.703 at r = 1.054: nothing is seen further out.
  const CameraModel camera = cameraWith({-0.3, 0, 0, 0, 0});
  EXPECT_TRUE(undistort(camera, {camera.cx + 0.70 * camera.fx, camera.cy}).allFinite());
  EXPECT_TRUE(undistort(camera, {camera.cx + 0.71 * camera.fx, camera.cy}).hasNaN());
  EXPECT_TRUE(undistort(camera, {camera.cx + 30 * camera.fx, camera.cy}).hasNaN());
  EXPECT_TRUE(undistort(camera, {std::nan(""), 0}).hasNaN());
}

}  // namespace
}  // namespace vibe::vision::camera_model_test
