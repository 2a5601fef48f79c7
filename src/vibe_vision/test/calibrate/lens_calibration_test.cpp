#include "vibe_vision/calibrate/lens_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibrate/rendered_board.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::lens_calibration_test {
namespace {

CameraModel bentLens() {
  CameraModel camera;
  camera.width = 728;
  camera.height = 544;
  camera.fx = 1500;
  camera.fy = 1503;
  camera.cx = 371.2;
  camera.cy = 265.8;
  camera.distortion = {-0.3, 0.12, 1e-3, -8e-4, 0};
  return camera;
}

constexpr double kDistance = 0.2;  // [m]

/// Exact corners plus Gaussian errors.
std::vector<BoardView> viewsOf(const CameraModel& camera, const std::vector<Eigen::Isometry3d>& poses, double error,
                               unsigned seed) {
  CameraModel small = camera;  // no pictures are drawn
  small.width = small.height = 1;
  const RenderedBoard board(small, kBoard);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, error);
  std::vector<BoardView> views;
  for (const Eigen::Isometry3d& pose : poses) {
    views.push_back({"image " + std::to_string(views.size()), board.corners(pose)});
    for (Eigen::Vector2d& corner : views.back().corners) corner += Eigen::Vector2d(normal(random), normal(random));
  }
  return views;
}

/// Largest distance between where the two lenses see the same direction, over the image [px].
double largestDifference(const CameraModel& a, const CameraModel& b) {
  double largest = 0;
  for (double x = 0; x < a.width; x += 24) {
    for (double y = 0; y < a.height; y += 24) {
      const Eigen::Vector2d p = undistort(a, {x, y}) - Eigen::Vector2d(a.cx, a.cy);
      const Eigen::Vector2d other(b.cx + p.x() / a.fx * b.fx, b.cy + p.y() / a.fy * b.fy);
      largest = std::max(largest, (distort(b, other) - Eigen::Vector2d(x, y)).norm());
    }
  }
  return largest;
}

bool anyContains(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(part) != std::string::npos; });
}

TEST(FindBoard, CornersOfARenderedBoardAreWherePixelCentresAreIntegers) {
  const CameraModel camera = bentLens();
  const RenderedBoard board(camera, kBoard);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0;
  int count = 0;
  for (const Eigen::Isometry3d& pose : boardPoses(camera, kBoard, kDistance, 4, 0.4)) {
    const std::vector<std::uint8_t> pixels = board.draw(pose, 2, 1);
    const auto found = findBoard(board.view(pixels), kBoard);
    ASSERT_TRUE(found.has_value());
    std::vector<Eigen::Vector2d> truth = board.corners(pose);
    if ((truth.front() - found->front()).norm() > 5) std::reverse(truth.begin(), truth.end());  // seen from its end
    for (std::size_t i = 0; i < truth.size(); ++i, ++count) {
      sum += (*found)[i] - truth[i];
      squares += ((*found)[i] - truth[i]).squaredNorm();
    }
  }
  EXPECT_LT((sum / count).norm(), 0.02);  // half a pixel would be the other convention
  EXPECT_LT(std::sqrt(squares / count), 0.07);
}

TEST(FindBoard, AnotherBoardOrNoneIsNotFound) {
  const CameraModel camera = bentLens();
  const RenderedBoard board(camera, kBoard);
  const std::vector<std::uint8_t> pixels = board.draw(boardPoses(camera, kBoard, kDistance, 1, 0.2)[0], 2, 1);
  EXPECT_TRUE(findBoard(board.view(pixels), kBoard).has_value());
  EXPECT_FALSE(findBoard(board.view(pixels), {10, 7, 5e-3}).has_value());
  const std::vector<std::uint8_t> grey(pixels.size(), 120);
  EXPECT_FALSE(findBoard(board.view(grey), kBoard).has_value());
}

TEST(LensCalibration, RenderedBoardsGiveTheLens) {
  const CameraModel camera = bentLens();
  const RenderedBoard board(camera, kBoard);
  std::vector<BoardView> views;
  for (const Eigen::Isometry3d& pose : boardPoses(camera, kBoard, kDistance, 14, 0.5)) {
    const std::vector<std::uint8_t> pixels = board.draw(pose, 2, static_cast<unsigned>(views.size()));
    const auto corners = findBoard(board.view(pixels), kBoard);
    ASSERT_TRUE(corners.has_value());
    views.push_back({"image " + std::to_string(views.size()), *corners});
  }
  const LensCalibration lens = calibrateLens(views, kBoard, camera.width, camera.height);
  EXPECT_LT(lens.camera.reprojection_rms, 0.1);
  EXPECT_NEAR(lens.camera.fx, camera.fx, 0.005 * camera.fx);
  EXPECT_LT(largestDifference(camera, lens.camera), 0.01 * 728);  // focal length and distance trade off
  EXPECT_NEAR(lens.camera.distortion[0], -0.3, 0.02);
}

/// Squared errors in units of the stated deviations have the mean 1.
TEST(LensCalibration, TheDeviationsAreThoseOfTheErrors) {
  const CameraModel camera = bentLens();
  const std::vector<Eigen::Isometry3d> poses = boardPoses(camera, kBoard, kDistance, 10, 0.5);
  constexpr int kRuns = 12;
  double sum = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const LensCalibration lens = calibrateLens(viewsOf(camera, poses, 0.1, seed), kBoard, 728, 544);
    EXPECT_NEAR(lens.camera.reprojection_rms, 0.1 * std::sqrt(2), 0.02);
    const double errors[] = {lens.camera.fx - camera.fx, lens.camera.fy - camera.fy, lens.camera.cx - camera.cx,
                             lens.camera.cy - camera.cy};
    for (std::size_t i = 0; i < 4; ++i) sum += std::pow(errors[i] / lens.deviation[i], 2) / 4 / kRuns;
  }
  EXPECT_GT(sum, 0.5);
  EXPECT_LT(sum, 2);
}

/// Of a long lens the focal length is the least certain: equations that are badly scaled lose it first.
TEST(LensCalibration, ALongLensIsUncertainAndSaysSo) {
  CameraModel camera;
  camera.width = 728, camera.height = 544;
  camera.fx = camera.fy = 4530;
  camera.cx = 361.4, camera.cy = 274.2;
  const std::vector<Eigen::Isometry3d> poses = boardPoses(camera, kBoard, 0.46, 14, 0.5);
  for (unsigned seed = 0; seed < 4; ++seed) {
    const LensCalibration lens = calibrateLens(viewsOf(camera, poses, 0.05, seed), kBoard, 728, 544);
    EXPECT_LT(std::abs(lens.camera.fx - camera.fx), 4 * lens.deviation[0]) << seed;
    EXPECT_LT(lens.deviation[0], 0.005 * camera.fx) << seed;
  }
}

TEST(LensCalibration, CoefficientsThatAreNotSeenAreZero) {
  CameraModel straight = bentLens();
  straight.distortion = {};
  const std::vector<Eigen::Isometry3d> poses = boardPoses(straight, kBoard, kDistance, 12, 0.5);
  const LensCalibration lens = calibrateLens(viewsOf(straight, poses, 0.1, 3), kBoard, 728, 544);
  EXPECT_FALSE(lens.estimated[4]);
  EXPECT_EQ(lens.camera.distortion[4], 0);
  const LensCalibration bent = calibrateLens(viewsOf(bentLens(), poses, 0.1, 3), kBoard, 728, 544);
  EXPECT_TRUE(bent.estimated[0]);
  CameraModel tangential = bentLens();  // small ones look like another principal point
  tangential.distortion = {-0.3, 0.12, 8e-3, -8e-3, 0};
  EXPECT_TRUE(calibrateLens(viewsOf(tangential, poses, 0.1, 3), kBoard, 728, 544).estimated[2]);
}

TEST(LensCalibration, GoodImagesGiveNoWarning) {
  const CameraModel camera = bentLens();
  const LensCalibration lens =
      calibrateLens(viewsOf(camera, boardPoses(camera, kBoard, kDistance, 20, 0.5), 0.05, 1), kBoard, 728, 544);
  EXPECT_TRUE(lens.warnings.empty()) << lens.warnings.front();
}

TEST(LensCalibration, DoubtfulImagesAreSaid) {
  const CameraModel camera = bentLens();
  const auto warnings = [&](const std::vector<BoardView>& views) {
    return calibrateLens(views, kBoard, 728, 544).warnings;
  };
  const std::vector<BoardView> few = viewsOf(camera, boardPoses(camera, kBoard, kDistance, 4, 0.5), 0.05, 1);
  EXPECT_TRUE(anyContains(warnings(few), "in 4 images only; take at least 8"));
  const std::vector<BoardView> flat = viewsOf(camera, boardPoses(camera, kBoard, kDistance, 20, 0.05), 0.05, 1);
  EXPECT_TRUE(anyContains(warnings(flat), "tilt it by 20 to 40 deg"));
  const std::vector<BoardView> far = viewsOf(camera, boardPoses(camera, kBoard, 3 * kDistance, 8, 0.5), 0.05, 1);
  EXPECT_TRUE(anyContains(warnings(far), "move it into all corners"));
  std::vector<BoardView> bad = viewsOf(camera, boardPoses(camera, kBoard, kDistance, 20, 0.5), 0.05, 1);
  for (std::size_t i = 0; i < bad[7].corners.size(); i += 2) bad[7].corners[i].y() += 1;
  EXPECT_TRUE(anyContains(warnings(bad), "image 7 fits badly"));
  const std::vector<BoardView> noisy = viewsOf(camera, boardPoses(camera, kBoard, kDistance, 20, 0.5), 1, 1);
  EXPECT_TRUE(anyContains(warnings(noisy), "px is large; check that the board is flat"));
}

TEST(LensCalibration, TooFewImagesAreAnError) {
  const CameraModel camera = bentLens();
  std::vector<BoardView> views = viewsOf(camera, boardPoses(camera, kBoard, kDistance, 2, 0.5), 0.05, 1);
  EXPECT_ERROR(calibrateLens(views, kBoard, 728, 544), "was found in 2 images, 3 are needed");
  views = viewsOf(camera, boardPoses(camera, kBoard, kDistance, 5, 0.5), 0.05, 1);
  views[3].corners.pop_back();
  EXPECT_ERROR(calibrateLens(views, kBoard, 728, 544), "image 3: has 53 corners");
}

}  // namespace
}  // namespace vibe::vision::lens_calibration_test
