#include "synthetic/surface.hpp"

#include "synthetic/plane_surface.hpp"
#include "synthetic/sleeve_surface.hpp"

namespace vibe::vision {

std::unique_ptr<Surface> makeSurface(const CameraModel& camera, const SyntheticInstrument& instrument,
                                     const MarkerFrame& frame, const Eigen::Vector2d& reference, double aperture) {
  if (instrument.tag.cells > 0)
    return std::make_unique<TagSurface>(instrument.tag, PlaneMap(camera, frame, reference, aperture));
  if (const auto* ring = std::get_if<RingDesign>(&instrument.nominal.marker))
    return std::make_unique<RingSurface>(*ring, PlaneMap(camera, frame, reference, aperture));
  return std::make_unique<SleeveSurface>(std::get<SleeveDesign>(instrument.nominal.marker), camera, frame, reference,
                                         aperture);
}

}  // namespace vibe::vision
