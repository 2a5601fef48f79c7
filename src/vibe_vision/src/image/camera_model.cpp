#include "vibe_vision/image/camera_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

/// A point of the plane z = 1 as the lens moves it, and the derivative.
struct LensPoint {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

LensPoint bend(const std::array<double, 5>& k, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double slope = 2 * (k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]));  // d radial / d x = slope * x
  LensPoint bent;
  bent.point = {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
                y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
  const double mixed = slope * x * y + 2 * k[2] * x + 2 * k[3] * y;
  bent.jacobian << radial + slope * x * x + 2 * k[2] * y + 6 * k[3] * x, mixed, mixed,
      radial + slope * y * y + 6 * k[2] * y + 2 * k[3] * x;
  return bent;
}

Eigen::Vector2d toPlane(const CameraModel& c, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy};
}

Eigen::Vector2d toPixel(const CameraModel& c, const Eigen::Vector2d& p) {
  return {c.fx * p.x() + c.cx, c.fy * p.y() + c.cy};
}

/// The lens maps the plane one to one only up to some radius, where its determinant vanishes. A point beyond it is no
/// inverse, even if it is mapped to the right place: the way to it from the centre must keep its orientation.
bool isReachable(const std::array<double, 5>& k, const Eigen::Vector2d& p) {
  constexpr int kSteps = 8;
  for (int i = 1; i <= kSteps; ++i)
    if (bend(k, p * i / kSteps).jacobian.determinant() <= 0) return false;
  return true;
}

}  // namespace

bool CameraModel::isDistorted() const {
  return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0; });
}

void requireSize(const CameraModel& camera, int width, int height, const std::string& whose,
                 const std::string& remedy) {
  if (width == camera.width && height == camera.height) return;
  throw Error(whose + " " + sizeText(width, height) + " px, the configuration is for " +
              sizeText(camera.width, camera.height) + " px; " + remedy);
}

Eigen::Vector2d undistort(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  if (!camera.isDistorted()) return pixel;
  constexpr int kIterations = 50;
  const Eigen::Vector2d wanted = toPlane(camera, pixel);
  const double tolerance = 1e-10 / std::max(std::abs(camera.fx), std::abs(camera.fy));
  Eigen::Vector2d p = wanted;
  for (int i = 0; i < kIterations; ++i) {
    const LensPoint bent = bend(camera.distortion, p);
    const Eigen::Vector2d error = bent.point - wanted;
    if (error.norm() <= std::max(tolerance, 4e-16 * wanted.norm()) && isReachable(camera.distortion, p))
      return toPixel(camera, p);
    const double determinant = bent.jacobian.determinant();
    if (!(determinant > 1e-6)) break;
    p -= bent.jacobian.inverse() * error;
  }
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

Eigen::Vector2d distort(const CameraModel& camera, const Eigen::Vector2d& undistorted) {
  if (!camera.isDistorted()) return undistorted;
  return toPixel(camera, bend(camera.distortion, toPlane(camera, undistorted)).point);
}

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d ideal = toPixel(camera, point.head<2>() / point.z());
  return distort(camera, ideal);
}

}  // namespace vibe::vision
