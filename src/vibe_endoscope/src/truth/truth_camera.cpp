#include "truth/truth_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe::endoscope {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// a ray to a point of a surface ends this much before it, so that the surface does not hide its own point
constexpr double kShortened = 1e-4;
constexpr int kTile = 4;  // edge of a square of pixels whose rays are cast together [px]

/// Poses of all bodies in the frame of a camera.
std::vector<Eigen::Isometry3d> posesIn(const Eigen::Isometry3d& camera, const TruthScene& scene) {
  const Eigen::Isometry3d to_camera = camera.inverse(Eigen::Isometry);
  std::vector<Eigen::Isometry3d> poses;
  for (std::uint32_t body = 0; body < scene.bodyCount(); ++body) poses.push_back(to_camera * scene.poseOf(body));
  return poses;
}

/// From what a ray has met to the camera, in the frame of the body.
Eigen::Vector3d backwards(const CameraRay& ray, const Eigen::Isometry3d& body) {
  return body.linear().transpose() * -ray.direction.cast<double>();
}

}  // namespace

TruthCamera::TruthCamera(const graphics::RoundCamera& round, double near, double far)
    : round_(round), near_(near), far_(far) {
  for (int top = 0; top < round.height; top += kTile)
    for (int left = 0; left < round.width; left += kTile)
      for (int y = top; y < std::min(top + kTile, round.height); ++y)
        for (int x = left; x < std::min(left + kTile, round.width); ++x) addPixel(x, y);
}

void TruthCamera::addPixel(int x, int y) {
  if (!isInside({x, y})) return;
  const Eigen::Vector3d ray = graphics::rayOf(round_, {x, y});
  pixels_.push_back(static_cast<std::uint32_t>(y * round_.width + x));
  rays_.push_back({ray.cast<float>(), static_cast<float>(near_ / ray.z()), static_cast<float>(far_ / ray.z())});
}

bool TruthCamera::isInside(const Eigen::Vector2d& pixel) const {
  const double radius = round_.radius();
  return (pixel - round_.middle()).squaredNorm() <= radius * radius;  // false for NaN
}

void TruthCamera::look(const TruthScene& scene, const Eigen::Isometry3d& pose, TruthView& view) const {
  view.pose = pose;
  scene.rays().firstHits(pose, rays_, view.hits);
  view.shapes.resize(scene.bodyCount());
  for (std::uint32_t body = 0; body < view.shapes.size(); ++body) view.shapes[body] = scene.shapeNumber(body);
}

std::vector<float> TruthCamera::depth(const TruthScene& scene, const TruthView& view) const {
  std::vector<float> image(pixelCount(), kNone);
  std::vector<Eigen::Vector4d> ahead;  // the row of a pose that gives the depth
  for (const Eigen::Isometry3d& pose : posesIn(view.pose, scene)) ahead.push_back(pose.matrix().row(2));
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    const SurfaceHit& hit = view.hits[k];
    if (!hit.any()) continue;
    const Eigen::Vector4d& row = ahead[hit.body];
    image[pixels_[k]] = static_cast<float>(row.head<3>().dot(scene.pointOf(hit)) + row[3]);
  }
  return image;
}

std::vector<float> TruthCamera::normals(const TruthScene& scene, const TruthView& view) const {
  std::vector<float> image(3 * pixelCount(), kNone);
  const std::vector<Eigen::Isometry3d> poses = posesIn(view.pose, scene);
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    const SurfaceHit& hit = view.hits[k];
    if (!hit.any()) continue;
    const Eigen::Isometry3d& pose = poses[hit.body];
    const Eigen::Vector3d normal = pose.linear() * scene.normalOf(hit, backwards(rays_[k], pose));
    for (std::size_t c = 0; c < 3; ++c) image[3 * pixels_[k] + c] = static_cast<float>(normal[static_cast<int>(c)]);
  }
  return image;
}

std::vector<std::uint8_t> TruthCamera::labels(const TruthScene& scene, const TruthView& view) const {
  std::vector<std::uint8_t> image(pixelCount(), kLabelNothing);
  const std::vector<Eigen::Isometry3d> poses = posesIn(view.pose, scene);
  for (std::size_t k = 0; k < pixels_.size(); ++k)
    if (const SurfaceHit& hit = view.hits[k]; hit.any())
      image[pixels_[k]] = scene.labelOf(hit, backwards(rays_[k], poses[hit.body]));
  return image;
}

TruthFlow TruthCamera::flow(const TruthView& before, const TruthScene& scene, const Eigen::Isometry3d& pose) const {
  TruthFlow flow;
  flow.motion.assign(2 * pixelCount(), kNone);
  flow.visible.assign(pixelCount(), 0);
  std::vector<std::uint32_t> moved;
  std::vector<CameraRay> rays;
  moved.reserve(pixels_.size()), rays.reserve(pixels_.size());
  const std::vector<Eigen::Isometry3d> poses = posesIn(pose, scene);
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    const SurfaceHit& hit = before.hits[k];
    if (!hit.any() || before.shapes[hit.body] == 0 || before.shapes[hit.body] != scene.shapeNumber(hit.body)) continue;
    const Eigen::Vector3d seen = poses[hit.body] * scene.pointOf(hit);
    if (!(seen.z() > 0 && seen.z() <= far_)) continue;
    const Eigen::Vector2d pixel = graphics::pixelOf(round_, seen);
    if (!isInside(pixel)) continue;
    const int at = static_cast<int>(pixels_[k]);
    flow.motion[2 * pixels_[k]] = static_cast<float>(pixel.x() - at % round_.width);
    flow.motion[2 * pixels_[k] + 1] = static_cast<float>(pixel.y() - at / round_.width);
    moved.push_back(pixels_[k]);
    const double distance = seen.norm();
    rays.push_back({(seen / distance).cast<float>(), static_cast<float>(near_ * distance / seen.z()),
                    static_cast<float>((1 - kShortened) * distance)});
  }
  hide(moved, rays, scene, pose, flow.visible);
  return flow;
}

void TruthCamera::hide(const std::vector<std::uint32_t>& pixels, const std::vector<CameraRay>& rays,
                       const TruthScene& scene, const Eigen::Isometry3d& pose,
                       std::vector<std::uint8_t>& visible) const {
  std::vector<std::uint8_t> blocked;
  scene.rays().areBlocked(pose, rays, blocked);
  for (std::size_t k = 0; k < pixels.size(); ++k)
    visible[pixels[k]] = blocked[k] != 0 ? TruthFlow::kHiddenNext : TruthFlow::kVisibleNext;
}

}  // namespace vibe::endoscope
