#pragma once
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "synthetic/scene_geometry.hpp"

namespace vibe::vision {

/// The black part of a marker as the camera sees it at one moment, drawn the other way round than the renderer does:
/// points of the print, by reflectance(), are projected forward and put into the pixels that they fall into.
struct ForwardPicture {
  std::vector<double> black;  ///< share of each pixel
  double area = 0;            ///< [px^2]
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();
};

inline Eigen::Vector3d pointOf(const RingDesign&, const MarkerFrame& f, double a, double b) {
  return f.centre + f.scale * (a * f.along + b * f.across);
}

/// @param b  angle from the direction to the camera [rad]
inline Eigen::Vector3d pointOf(const SleeveDesign& design, const MarkerFrame& f, double a, double b) {
  const Eigen::Vector3d view = -f.centre;
  const Eigen::Vector3d facing = (view - view.dot(f.along) * f.along).normalized();
  const Eigen::Vector3d side = f.along.cross(facing), normal = std::cos(b) * facing + std::sin(b) * side;
  return f.centre + f.scale * (a * f.along + design.diameter / 2 * normal);
}

inline bool isBlack(const RingDesign& design, const MarkerFrame&, double a, double b) {
  return reflectance(design, a, b) < 0.5;
}

inline bool isBlack(const SleeveDesign& design, const MarkerFrame& f, double a, double b) {
  return reflectance(design, a, b - f.rotation) < 0.5;
}

/// Spreads an area over the pixels that a rectangle with these half extents touches, at most 2 x 2.
inline void deposit(const CameraModel& camera, const Eigen::Vector2d& pixel, const Eigen::Vector2d& half, double area,
                    std::vector<double>& image) {
  const long x = std::lround(pixel.x() - half.x()), y = std::lround(pixel.y() - half.y());
  const double right = std::max(0.0, pixel.x() + half.x() - (static_cast<double>(x) + 0.5)) / (2 * half.x());
  const double below = std::max(0.0, pixel.y() + half.y() - (static_cast<double>(y) + 0.5)) / (2 * half.y());
  for (const int j : {0, 1})
    for (const int i : {0, 1}) {
      if (x + i < 0 || y + j < 0 || x + i >= camera.width || y + j >= camera.height) continue;
      image[static_cast<std::size_t>((y + j) * camera.width + x + i)] +=
          area * (i == 1 ? right : 1 - right) * (j == 1 ? below : 1 - below);
    }
}

/// @param half  extents of the two coordinates of the design, @param step  between points in these
template <class Design>
ForwardPicture forwardPicture(const CameraModel& camera, const Design& design, const MarkerFrame& frame,
                              const Eigen::Vector2d& half, const Eigen::Vector2d& step) {
  ForwardPicture picture;
  picture.black.assign(static_cast<std::size_t>(camera.width * camera.height), 0);
  Eigen::Vector2d square = Eigen::Vector2d::Zero();
  for (double a = -half.x() + step.x() / 2; a < half.x(); a += step.x())
    for (double b = -half.y() + step.y() / 2; b < half.y(); b += step.y()) {
      if (!isBlack(design, frame, a, b)) continue;
      const Eigen::Vector2d pixel = project(camera, pointOf(design, frame, a, b));
      Eigen::Matrix2d steps;
      const double u = step.x() / 2, v = step.y() / 2;
      steps.col(0) =
          project(camera, pointOf(design, frame, a + u, b)) - project(camera, pointOf(design, frame, a - u, b));
      steps.col(1) =
          project(camera, pointOf(design, frame, a, b + v)) - project(camera, pointOf(design, frame, a, b - v));
      const double area = steps.determinant();
      if (area <= 0) continue;  // the back of a sleeve
      picture.area += area;
      picture.centroid += area * pixel;
      square += area * pixel.cwiseAbs2();
      deposit(camera, pixel, steps.cwiseAbs().rowwise().sum() / 2, area, picture.black);
    }
  picture.centroid /= picture.area;
  picture.variance = square / picture.area - picture.centroid.cwiseAbs2();
  return picture;
}

}  // namespace vibe::vision
