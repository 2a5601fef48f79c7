#include "ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vibe::python {

namespace {

constexpr double kNear = 1e-6;  // what is nearer along the optical axis is not seen [m]

struct Lens {
  double focal;  // [pixels]
  double centre_x, centre_y;
};

/// The pixels that a triangle may cover.
struct Window {
  int left = 0, right = 0, top = 0, bottom = 0;  // the last ones do not belong to it
};

// A corner behind the camera may be anywhere in the picture.
Window windowOf(const Eigen::Vector3d* const (&corner)[3], const Lens& lens, const CastImage& image) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector3d* p : corner) {
    if (!(p->z() > kNear)) return {0, image.width, 0, image.height};
    const Eigen::Array2d pixel = lens.focal * p->head<2>().array() / p->z();
    low = low.min(pixel);
    high = high.max(pixel);
  }
  const auto within = [](double place, int size) {
    return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(size)));
  };
  return {within(std::floor(low.x() + lens.centre_x), image.width),
          within(std::ceil(high.x() + lens.centre_x) + 1, image.width),
          within(std::floor(low.y() + lens.centre_y), image.height),
          within(std::ceil(high.y() + lens.centre_y) + 1, image.height)};
}

/// The rays (u, v, 1) / focal against one triangle: signs of volumes, linear in u and v (Moeller and Trumbore 1997 with
/// the camera as origin).
class TriangleCast {
 public:
  TriangleCast(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : side_{b.cross(c), c.cross(a), a.cross(b)}, normal_((b - a).cross(c - a)), height_(normal_.dot(a)) {}

  // @return depth along the optical axis; 0: missed
  double depth(const Eigen::Vector3d& ray) const {
    const double p = ray.dot(side_[0]), q = ray.dot(side_[1]), r = ray.dot(side_[2]);
    if (!((p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0))) return 0;
    const double slope = ray.dot(normal_);
    return slope == 0 ? 0 : height_ / slope;
  }
  const Eigen::Vector3d& normal() const { return normal_; }

 private:
  Eigen::Vector3d side_[3], normal_;
  double height_;
};

void cast(const TriangleCast& triangle, int number, const Window& window, const Lens& lens, CastImage& image) {
  for (int v = window.top; v < window.bottom; ++v)
    for (int u = window.left; u < window.right; ++u) {
      const Eigen::Vector3d ray((u + 0.5 - lens.centre_x) / lens.focal, (v + 0.5 - lens.centre_y) / lens.focal, 1);
      const double depth = triangle.depth(ray);
      const int pixel = v * image.width + u;
      if (!(depth > kNear) || image.depth[pixel] <= static_cast<float>(depth)) continue;
      image.depth[pixel] = static_cast<float>(depth);
      image.triangle[pixel] = number;
    }
}

void findNormals(const SurfaceView& surface, const std::vector<Eigen::Vector3d>& place, CastImage& image) {
  for (int i = 0; i < image.width * image.height; ++i) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (image.triangle[i] >= 0) {
      const auto& t = surface.triangles[static_cast<std::size_t>(image.triangle[i])];
      normal = (place[t[1]] - place[t[0]]).cross(place[t[2]] - place[t[0]]).normalized();
      if (normal.dot(place[t[0]]) > 0) normal = -normal;
    }
    for (int k = 0; k < 3; ++k) image.normal[3 * i + k] = static_cast<float>(normal[k]);
  }
}

}  // namespace

void castRays(const SurfaceView& surface, const Eigen::Isometry3d& camera, double field_of_view, CastImage& image) {
  const Lens lens{image.width / (2 * std::tan(field_of_view / 2)), image.width / 2.0, image.height / 2.0};
  const Eigen::Isometry3d to_camera = camera.inverse();
  std::vector<Eigen::Vector3d> place(surface.x.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = to_camera * surface.position(static_cast<int>(i));
  const int pixels = image.width * image.height;
  std::fill_n(image.depth, pixels, std::numeric_limits<float>::infinity());
  std::fill_n(image.triangle, pixels, -1);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    const Eigen::Vector3d* const corner[3] = {&place[t[0]], &place[t[1]], &place[t[2]]};
    if (corner[0]->z() <= kNear && corner[1]->z() <= kNear && corner[2]->z() <= kNear) continue;
    const Window window = windowOf(corner, lens, image);
    cast(TriangleCast(*corner[0], *corner[1], *corner[2]), static_cast<int>(i), window, lens, image);
  }
  for (int i = 0; i < pixels; ++i)
    if (image.triangle[i] < 0) image.depth[i] = std::numeric_limits<float>::quiet_NaN();
  if (image.normal != nullptr) findNormals(surface, place, image);
}

}  // namespace vibe::python
