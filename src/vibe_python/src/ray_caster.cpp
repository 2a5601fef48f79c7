#include "ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vibe::python {

namespace {

constexpr double kNear = 1e-6;      // what is nearer along the optical axis is not seen [m]
constexpr double kRounding = 1e-6;  // of the edge of a triangle in the picture [pixels]

/// The pixels that a triangle may cover.
struct Window {
  int left = 0, right = 0, top = 0, bottom = 0;  // the last ones do not belong to it
};

/// A vertex as the camera sees it.
struct Corner {
  Eigen::Vector3d place;  // in the camera [m]
  Eigen::Array2d pixel;   // not a number behind the camera
  unsigned beyond;        // a bit per plane of the picture's pyramid that it is outside of
};

constexpr unsigned kBehind = 1;

// The pyramid ends half a pixel outside the outermost rays, far beyond rounding.
Corner cornerAt(const Eigen::Vector3d& place, const Lens& lens) {
  const double x = lens.focal * place.x(), y = lens.focal * place.y();
  const double right = lens.centre_x * place.z(), low = lens.centre_y * place.z();
  Corner corner{place, {x / place.z() + lens.centre_x, y / place.z() + lens.centre_y}, 0};
  if (!(place.z() > kNear)) corner.beyond |= kBehind;
  if (x > right) corner.beyond |= 2;
  if (x < -right) corner.beyond |= 4;
  if (y > low) corner.beyond |= 8;
  if (y < -low) corner.beyond |= 16;
  return corner;
}

// A corner behind the camera may be anywhere in the picture.
Window windowOf(const Corner& a, const Corner& b, const Corner& c, const CastImage& image) {
  if (((a.beyond | b.beyond | c.beyond) & kBehind) != 0) return {0, image.width, 0, image.height};
  const Eigen::Array2d low = a.pixel.min(b.pixel).min(c.pixel), high = a.pixel.max(b.pixel).max(c.pixel);
  const auto first = [](double edge, int size) {
    return static_cast<int>(std::clamp(std::ceil(edge - 0.5 - kRounding), 0.0, static_cast<double>(size)));
  };
  const auto last = [](double edge, int size) {
    return static_cast<int>(std::clamp(std::floor(edge - 0.5 + kRounding) + 1, 0.0, static_cast<double>(size)));
  };
  return {first(low.x(), image.width), last(high.x(), image.width), first(low.y(), image.height),
          last(high.y(), image.height)};
}

/// The rays (x, y, 1) of a row of the picture against one triangle: signs of volumes, linear in x (Moeller and Trumbore
/// 1997 with the camera as origin).
class TriangleCast {
 public:
  TriangleCast(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    rows_ << b.cross(c).transpose(), c.cross(a).transpose(), a.cross(b).transpose(), normal.transpose();
    height_ = normal.dot(a);
  }

  void beginRow(double y) { row_ = rows_.col(1) * y + rows_.col(2); }
  // @return depth along the optical axis; 0: missed
  double depth(double x) const {
    const Eigen::Vector4d value = rows_.col(0) * x + row_;
    const bool in = value[0] >= 0 && value[1] >= 0 && value[2] >= 0,
               out = value[0] <= 0 && value[1] <= 0 && value[2] <= 0;
    return (in || out) && value[3] != 0 ? height_ / value[3] : 0;
  }

 private:
  Eigen::Matrix<double, 4, 3> rows_;
  Eigen::Vector4d row_;
  double height_;
};

void cast(TriangleCast triangle, int number, const Window& window, const Lens& lens, CastImage& image) {
  for (int v = window.top; v < window.bottom; ++v) {
    triangle.beginRow((v + 0.5 - lens.centre_y) / lens.focal);
    for (int u = window.left; u < window.right; ++u) {
      const double depth = triangle.depth((u + 0.5 - lens.centre_x) / lens.focal);
      const int pixel = v * image.width + u;
      if (!(depth > kNear) || image.depth[pixel] <= static_cast<float>(depth)) continue;
      image.depth[pixel] = static_cast<float>(depth);
      image.triangle[pixel] = number;
    }
  }
}

void findNormals(const SurfaceView& surface, const std::vector<Corner>& corner, CastImage& image) {
  for (int i = 0; i < image.width * image.height; ++i) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (image.triangle[i] >= 0) {
      const auto& t = surface.triangles[static_cast<std::size_t>(image.triangle[i])];
      const Eigen::Vector3d &a = corner[t[0]].place, &b = corner[t[1]].place, &c = corner[t[2]].place;
      normal = (b - a).cross(c - a).normalized();
      if (normal.dot(a) > 0) normal = -normal;
    }
    for (int k = 0; k < 3; ++k) image.normal[3 * i + k] = static_cast<float>(normal[k]);
  }
}

}  // namespace

// Rounded to 40 binary places, because the last bit of the tangent depends on the version of the C library.
Lens::Lens(int width, int height, double field_of_view)
    : focal(width / (2 * std::nearbyint(std::tan(field_of_view / 2) * 0x1p40) * 0x1p-40)),
      centre_x(width / 2.0),
      centre_y(height / 2.0) {}

void castRays(const SurfaceView& surface, const Eigen::Isometry3d& camera, double field_of_view, CastImage& image) {
  const Lens lens(image.width, image.height, field_of_view);
  const Eigen::Isometry3d to_camera = camera.inverse();
  std::vector<Corner> corner(surface.x.size());
  for (std::size_t i = 0; i < corner.size(); ++i)
    corner[i] = cornerAt(to_camera * surface.position(static_cast<int>(i)), lens);
  const int pixels = image.width * image.height;
  std::fill_n(image.depth, pixels, std::numeric_limits<float>::infinity());
  std::fill_n(image.triangle, pixels, -1);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    const Corner &a = corner[t[0]], &b = corner[t[1]], &c = corner[t[2]];
    if ((a.beyond & b.beyond & c.beyond) != 0) continue;
    const Window window = windowOf(a, b, c, image);
    if (window.left >= window.right || window.top >= window.bottom) continue;
    cast(TriangleCast(a.place, b.place, c.place), static_cast<int>(i), window, lens, image);
  }
  for (int i = 0; i < pixels; ++i)
    if (image.triangle[i] < 0) image.depth[i] = std::numeric_limits<float>::quiet_NaN();
  if (image.normal != nullptr) findNormals(surface, corner, image);
}

}  // namespace vibe::python
