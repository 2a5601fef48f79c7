#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_vision/image/camera_model.hpp"
#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

/// Chessboard for the calibration of the lens, counted by its inner corners as OpenCV does.
struct BoardSpec {
  int columns = 9, rows = 6;  ///< inner corners along a row, and rows of them
  double square = 5e-3;       ///< side of a square [m]
};

/// One image of the chessboard.
struct BoardView {
  std::string name;                      ///< of the image, for messages
  std::vector<Eigen::Vector2d> corners;  ///< row by row [px]
};

/// Inner corners of a chessboard, about 0.05 px RMS in a sharp image: OpenCV's findChessboardCornersSB, checked against
/// their neighbours and refined by the gradients around each. The whole board must be seen. @return nothing if it is
/// not
std::optional<std::vector<Eigen::Vector2d>> findBoard(const ImageView& image, const BoardSpec& board);

/// What came of one image.
struct BoardFit {
  std::string name;  ///< of the image
  double rms = 0;    ///< distance of the corners from where the model sees them [px]
  double tilt = 0;   ///< of the board against the sensor [rad]
};

struct LensCalibration {
  CameraModel camera;                 ///< with reprojection_rms, over all corners
  std::array<double, 4> deviation{};  ///< standard deviations of fx, fy, cx, cy [px]
  std::array<bool, 5> estimated{};    ///< of the distortion; coefficients that the images do not show are 0
  std::vector<BoardFit> views;        ///< one per image, in the order given
  double coverage = 0;                ///< share of the image in which corners were seen
  std::vector<std::string> warnings;  ///< sentences with their remedies
};

/// Fits pinhole and distortion (Zhang 2000; OpenCV's calibrateCamera). Of the distortion only what makes the residual
/// clearly smaller is estimated (F test at 4 standard deviations): k1, the tangential part, k2, k3 in this order.
/// @throws Error for fewer than 3 views, or a view with another number of corners
LensCalibration calibrateLens(const std::vector<BoardView>& views, const BoardSpec& board, int width, int height);

}  // namespace vibe::vision
