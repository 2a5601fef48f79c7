#pragma once
#include <vector>

#include "synthetic/edge_share.hpp"
#include "synthetic/surface.hpp"
#include "synthetic/view_ray.hpp"

namespace vibe::vision {

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
