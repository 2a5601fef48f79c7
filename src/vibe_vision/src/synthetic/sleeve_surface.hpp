#pragma once
#include <vector>

#include "synthetic/surface.hpp"
#include "synthetic/view_ray.hpp"

namespace vibe {

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

  float helixBlack(float u, float phi, float along, float phase_width) const;

  SleeveDesign design_;
  RayPart along_, across_, depth_, start_;
  Aperture aperture_{};
  std::vector<Edges> bars_;
  float radius_, half_length_, distance_, rotation_;
  float inverse_pitch_, duty_;
};

}  // namespace vibe
