#include "synthetic/marker_frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

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

}  // namespace vibe::vision
