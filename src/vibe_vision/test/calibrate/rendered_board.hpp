#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "vibe_vision/calibrate/lens_calibration.hpp"
#include "vibe_vision/image/camera_model.hpp"
#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

const BoardSpec kBoard{9, 6, 5e-3};

/// Of half a picture's width and height, so that boards are drawn fast.
inline CameraModel smallCamera() {
  CameraModel camera;
  camera.width = 364, camera.height = 272;
  camera.fx = camera.fy = 750;
  camera.cx = 181.5, camera.cy = 135.5;
  return camera;
}

/// Pictures of a chessboard in the world: each pixel is the mean of rays through the lens, plus noise.
class RenderedBoard {
 public:
  RenderedBoard(const CameraModel& camera, const BoardSpec& board) : camera_(camera), board_(board) {
    // rays at the corners of the pixels; in between they are interpolated, the lens is smooth
    for (int y = 0; y <= camera.height; ++y) {
      for (int x = 0; x <= camera.width; ++x) {
        const Eigen::Vector2d p = undistort(camera, {x - 0.5, y - 0.5});
        rays_.emplace_back((p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy);
      }
    }
  }

  /// @param pose  from the board (corner (0, 0) at its origin, x along the columns) to the camera [m]
  std::vector<std::uint8_t> draw(const Eigen::Isometry3d& pose, double noise, unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, noise);
    const Eigen::Isometry3d to_board = pose.inverse();
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(camera_.width * camera_.height));
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        const double value = 30 + 150 * mean(to_board, x, y) + normal(random);
        pixels.push_back(static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, value)))));
      }
    }
    return pixels;
  }

  ImageView view(const std::vector<std::uint8_t>& pixels) const {
    return {pixels.data(), camera_.width, camera_.height, camera_.width};
  }

  /// Where the inner corners are seen, row by row [px].
  std::vector<Eigen::Vector2d> corners(const Eigen::Isometry3d& pose) const {
    std::vector<Eigen::Vector2d> result;
    for (int row = 0; row < board_.rows; ++row) {
      for (int column = 0; column < board_.columns; ++column)
        result.push_back(project(camera_, pose * Eigen::Vector3d(column * board_.square, row * board_.square, 0)));
    }
    return result;
  }

 private:
  static constexpr int kSamples = 4;
  CameraModel camera_;
  BoardSpec board_;
  std::vector<Eigen::Vector2d> rays_;

  const Eigen::Vector2d& ray(int x, int y) const {
    return rays_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width + 1) +
                 static_cast<std::size_t>(x)];
  }

  double mean(const Eigen::Isometry3d& to_board, int x, int y) const {
    double sum = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const double u = (i % kSamples + 0.5) / kSamples, v = (i / kSamples + 0.5) / kSamples;
      const Eigen::Vector2d at =
          (1 - v) * ((1 - u) * ray(x, y) + u * ray(x + 1, y)) + v * ((1 - u) * ray(x, y + 1) + u * ray(x + 1, y + 1));
      sum += white(to_board, at);
    }
    return sum / (kSamples * kSamples);
  }

  double white(const Eigen::Isometry3d& to_board, const Eigen::Vector2d& at) const {
    const Eigen::Vector3d centre = to_board.translation();
    const Eigen::Vector3d direction = to_board.linear() * Eigen::Vector3d(at.x(), at.y(), 1);
    const Eigen::Vector3d point = centre - direction * (centre.z() / direction.z());
    const auto column = static_cast<int>(std::floor(point.x() / board_.square)) + 1;
    const auto row = static_cast<int>(std::floor(point.y() / board_.square)) + 1;
    if (column < 0 || row < 0 || column > board_.columns || row > board_.rows) return 1;
    return (row + column) % 2;
  }
};

/// Poses that a person would choose: all over the image, tilted to all sides.
inline std::vector<Eigen::Isometry3d> boardPoses(const CameraModel& camera, const BoardSpec& board, double distance,
                                                 int count, double tilt) {
  std::vector<Eigen::Isometry3d> poses;
  const Eigen::Vector3d middle((board.columns - 1) * board.square / 2, (board.rows - 1) * board.square / 2, 0);
  for (int i = 0; i < count; ++i) {
    const double angle = 2.4 * i, out = std::sqrt(static_cast<double>(i) / count);
    const Eigen::Vector3d axis(std::cos(1.7 * angle), std::sin(1.7 * angle), 0.3);
    const double z = distance * (1 + 0.08 * std::sin(3.0 * i));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0.21 * out * std::cos(angle) * camera.width / camera.fx * z,
                                   0.28 * out * std::sin(angle) * camera.height / camera.fy * z, z));
    pose.rotate(Eigen::AngleAxisd(tilt, axis.normalized()));
    pose.translate(-middle);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace vibe::vision
