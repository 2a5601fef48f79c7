#include "synthetic/scene_geometry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

AxisLine axisLine(const CameraModel& camera, const SlideAxis& axis) {
  // A point s along the line, at depth z0 (1 + p s), is seen at o + direction * along(s). Solved for the line's
  // direction: lateral parts (ppm direction + (o - c) p) z0 / f, depth p z0. Its length is 1, which gives z0.
  const Eigen::Array2d focal(camera.fx, camera.fy);
  const Eigen::Array2d offset = axis.origin.array() - Eigen::Array2d(camera.cx, camera.cy);
  const Eigen::Array2d lateral = (axis.pixels_per_metre * axis.direction.array() + offset * axis.perspective) / focal;
  const Eigen::Vector3d slope(lateral.x(), lateral.y(), axis.perspective);
  const double depth = 1 / slope.norm();
  return {depth * Eigen::Vector3d(offset.x() / camera.fx, offset.y() / camera.fy, 1), slope * depth};
}

MarkerFrame markerFrame(const CameraModel& camera, const SyntheticInstrument& instrument, double time) {
  const AxisLine line = axisLine(camera, instrument.nominal.axis);
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(line.direction).normalized();
  const Eigen::Vector3d away = line.direction.cross(across);
  const double tilt = instrument.tilt, slant = instrument.slant;
  const Eigen::Vector3d tilted = std::cos(tilt) * line.direction + std::sin(tilt) * across;
  MarkerFrame frame;
  frame.centre = line.origin + instrument.motion.slide(time) * line.direction + instrument.lateral * across;
  frame.along = std::cos(slant) * tilted + std::sin(slant) * away;
  frame.across = std::cos(tilt) * across - std::sin(tilt) * line.direction;
  frame.away = frame.along.cross(frame.across);
  frame.scale = instrument.scale;
  frame.rotation = instrument.motion.rotation ? instrument.motion.rotation(time) : 0;
  return frame;
}

Eigen::Vector2d projectIdeal(const CameraModel& camera, const Eigen::Vector3d& point) {
  return {camera.fx * point.x() / point.z() + camera.cx, camera.fy * point.y() / point.z() + camera.cy};
}

Eigen::Vector2d halfExtents(const SyntheticInstrument& instrument) {
  Eigen::Vector2d half;
  if (instrument.tag.cells > 0) {
    half.setConstant(instrument.tag.side * (0.5 + 1.0 / instrument.tag.cells));
  } else if (const auto* ring = std::get_if<RingDesign>(&instrument.nominal.marker)) {
    half.setConstant(ring->side / 2);
  } else {
    const auto& sleeve = std::get<SleeveDesign>(instrument.nominal.marker);
    half = {sleeve.length / 2, sleeve.diameter / 2};
  }
  return half * instrument.scale;
}

namespace {

/// Derivative of undistort(), from that of its inverse by central differences.
Eigen::Matrix2f derivative(const CameraModel& camera, const Eigen::Vector2d& undistorted) {
  constexpr double kStep = 0.05;  // [px]
  Eigen::Matrix2d distortion;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
    distortion.col(i) = (distort(camera, undistorted + step) - distort(camera, undistorted - step)) / (2 * kStep);
  }
  return distortion.inverse().cast<float>();
}

}  // namespace

SensorMap::SensorMap(const CameraModel& camera) : camera_(camera) {
  if (!camera.isDistorted()) return;
  entries_.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d place = undistort(camera, {x, y});
      if (!place.allFinite())
        throw Error("synthetic scene: the camera's distortion cannot be inverted at pixel (" + std::to_string(x) +
                    ", " + std::to_string(y) + "); make its coefficients smaller.");
      entries_.push_back({place, derivative(camera, place)});
    }
}

SensorMap::Entry SensorMap::at(int x, int y) const {
  if (entries_.empty()) return {{x, y}, Eigen::Matrix2f::Identity()};
  const int column = std::clamp(x, 0, camera_.width - 1), row = std::clamp(y, 0, camera_.height - 1);
  Entry entry = entries_[static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width) +
                         static_cast<std::size_t>(column)];
  const Eigen::Vector2d beyond(x - column, y - row);
  entry.place += entry.jacobian.cast<double>() * beyond;
  return entry;
}

}  // namespace vibe::vision
