#include "tag/tag_place.hpp"

#include <Eigen/LU>
#include <cmath>

namespace vibe::vision {

TagPlace TagPlace::of(const CameraModel& camera, const TagCorners& corners, const Eigen::Vector2d& shift, double side) {
  std::array<Eigen::Vector2d, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = undistort(camera, corners[i] + shift);
  const auto u = [&] { return Eigen::Vector2d((p[1] + p[2] - p[0] - p[3]) / (2 * side)); };
  const auto v = [&] { return Eigen::Vector2d((p[2] + p[3] - p[0] - p[1]) / (2 * side)); };
  TagPlace place;
  place.picture << u(), v();
  if (place.picture.determinant() < 0) {  // corners the other way round
    std::swap(p[1], p[3]);
    place.picture << u(), v();
  }
  place.centre = (p[0] + p[1] + p[2] + p[3]) / 4;
  place.pixels_per_metre = std::sqrt(std::abs(place.picture.determinant()));
  place.misfit = ((p[0] - p[1] + p[2] - p[3]) / 4).norm();
  return place;
}

}  // namespace vibe::vision
