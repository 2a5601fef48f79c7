#pragma once
#include "synthetic/edge_share.hpp"
#include "synthetic/surface.hpp"
#include "synthetic/view_ray.hpp"

namespace vibe::vision {

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

}  // namespace vibe::vision
