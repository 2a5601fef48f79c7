#pragma once

#include <memory>
#include <vector>

#include "synthetic/scene_geometry.hpp"

namespace vibe::vision {

/// Share of an aperture of width `width` that lies on the positive side of an edge across it, at distance `distance`.
inline float edgeShare(float distance, float inverse_width) {
  const float share = 0.5F + distance * inverse_width;
  return share < 0.0F ? 0.0F : (share > 1.0F ? 1.0F : share);
}

/// The directions in which a function changes over a square aperture: by `wide` and `narrow` from side to side.
struct ApertureSpread {
  float wide, narrow;
};

/// @param x, y  change of a function over the aperture in both directions
inline ApertureSpread apertureSpread(float x, float y) {
  const float a = x < 0 ? -x : x, b = y < 0 ? -y : y;
  const float wide = a > b ? a : b, narrow = a > b ? b : a, least = 0.05F * wide;
  return {wide, narrow < least ? least : narrow};
}

/// Share of a square aperture where a linear function is positive; `value` in its middle. Exact: the value in a square
/// is distributed as the sum of two uniform ones.
inline float positiveShare(float value, const ApertureSpread& spread) {
  const auto square = [](float t) { return t > 0 ? t * t : 0.0F; };
  const float outer = (spread.wide + spread.narrow) / 2, inner = (spread.wide - spread.narrow) / 2;
  const float area = square(value + outer) - square(value + inner) - square(value - inner) + square(value - outer);
  const float share = area / (2 * spread.wide * spread.narrow);
  return share > 1 ? 1.0F : (share < 0 ? 0.0F : share);  // rounding
}

/// One coordinate of the ray through a pixel, linear in the pixel: value + x dx + y dy.
struct RayPart {
  float value = 0, dx = 0, dy = 0;
  float at(float x, float y) const { return value + x * dx + y * dy; }
};

/// Rays of an ideal camera around a reference pixel: the part of the ray (X, Y, 1) in a direction.
class ViewRay {
 public:
  ViewRay(const CameraModel& camera, const Eigen::Vector2d& reference)
      : inverse_focal_(1 / camera.fx, 1 / camera.fy),
        centre_((reference.x() - camera.cx) / camera.fx, (reference.y() - camera.cy) / camera.fy, 1) {}

  /// Weighted by any vector [m].
  RayPart part(const Eigen::Vector3d& weight) const {
    return {static_cast<float>(weight.dot(centre_)), static_cast<float>(weight.x() * inverse_focal_.x()),
            static_cast<float>(weight.y() * inverse_focal_.y())};
  }
  /// Through the reference; its z is 1.
  const Eigen::Vector3d& centre() const { return centre_; }
  /// Change of the ray per pixel: (x, 0, 0) and (0, y, 0).
  const Eigen::Vector2d& perPixel() const { return inverse_focal_; }

 private:
  Eigen::Vector2d inverse_focal_;
  Eigen::Vector3d centre_;
};

/// A marker at one moment, as seen through small square apertures: what share of each it covers, and how white it is
/// there. Edges are integrated over the aperture by their distance, not sampled.
class Surface {
 public:
  virtual ~Surface() = default;
  /// @param x, y      centres of the apertures, undistorted [px], relative to the reference of makeSurface
  /// @param coverage  0: beside the marker, 1: on it
  /// @param white     reflectance of the marker in the aperture
  virtual void row(const float* x, const float* y, int count, float* coverage, float* white) const = 0;
};

/// @param reference  undistorted pixel that coordinates are relative to
/// @param aperture   side of the apertures, undistorted [px]
std::unique_ptr<Surface> makeSurface(const CameraModel& camera, const SyntheticInstrument& instrument,
                                     const MarkerFrame& frame, const Eigen::Vector2d& reference, double aperture);

/// A flat marker: maps pixels to coordinates of the printed plane, in metres of the design.
class PlaneMap {
 public:
  PlaneMap(const CameraModel& camera, const MarkerFrame& frame, const Eigen::Vector2d& reference, double aperture);

  float along(float x, float y) const { return along_.at(x, y) / depth_.at(x, y); }
  float across(float x, float y) const { return across_.at(x, y) / depth_.at(x, y); }
  float aperture() const { return aperture_; }  ///< side on the print, mean of both directions [m]
  /// Change of a function over an aperture, from its derivatives along and across.
  ApertureSpread spread(float along, float across) const {
    return apertureSpread(along * step_x_[0] + across * step_x_[1], along * step_y_[0] + across * step_y_[1]);
  }

 private:
  RayPart along_, across_, depth_;
  float aperture_;
  float step_x_[2], step_y_[2];  // along and across, from side to side of an aperture [m]
};

/// A black ring on a white square.
class RingSurface : public Surface {
 public:
  RingSurface(const RingDesign& design, const PlaneMap& map) : design_(design), map_(map) {}
  void row(const float* x, const float* y, int count, float* coverage, float* white) const override;

 private:
  RingDesign design_;
  PlaneMap map_;
};

/// A square of cells with a white border of one cell.
class TagSurface : public Surface {
 public:
  TagSurface(const SyntheticTag& tag, const PlaneMap& map);
  void row(const float* x, const float* y, int count, float* coverage, float* white) const override;

 private:
  float cellWhite(int column, int row) const;

  SyntheticTag tag_;
  PlaneMap map_;
  float cell_;  // side [m]
};

/// A printed cylinder: each ray is intersected with it.
class SleeveSurface : public Surface {
 public:
  SleeveSurface(const SleeveDesign& design, const CameraModel& camera, const MarkerFrame& frame,
                const Eigen::Vector2d& reference, double aperture);
  void row(const float* x, const float* y, int count, float* coverage, float* white) const override;

 private:
  struct Aperture {
    float across, along;  // side on the print [m]; along: where the camera looks at it at a right angle to the rod
  };
  struct Edges {
    float begin, end;  // of a bar [m]
  };

  /// Change of a function over an aperture, from the changes along and across the rod's picture.
  ApertureSpread spread(float along, float across) const {
    return apertureSpread(along * direction_x_ - across * direction_y_, along * direction_y_ + across * direction_x_);
  }
  /// Strips are as long as the apertures, but `share` times as wide; they lie `offset` apertures beside them.
  void strips(const float* x, const float* y, int count, float offset, float share, float* coverage,
              float* white) const;
  bool nearOutline(const float* x, const float* y, int count) const;
  float helixBlack(float u, float phi, float along, const ApertureSpread& phase) const;

  SleeveDesign design_;
  RayPart along_, across_, depth_, start_;
  Aperture aperture_{};
  float side_ = 0;  // of an aperture, undistorted [px]
  std::vector<Edges> bars_;
  float radius_, half_length_, distance_, rotation_;
  float inverse_pitch_, duty_;
  float direction_x_, direction_y_;  // of the rod in the image
};

}  // namespace vibe::vision
