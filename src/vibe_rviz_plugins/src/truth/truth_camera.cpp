#include "truth/truth_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// a ray to a point of a surface ends this much before it, so that the surface does not hide its own point [1]
constexpr double kShortened = 1e-4;

}  // namespace

TruthCamera::TruthCamera(const RoundCamera& round, double near, double far) : round_(round), near_(near), far_(far) {
  for (int y = 0; y < round.height; ++y)
    for (int x = 0; x < round.width; ++x) {
      if (!isInside({x, y})) continue;
      const Eigen::Vector3d ray = rayOf(round, {x, y});
      pixels_.push_back(static_cast<std::uint32_t>(y * round.width + x));
      rays_.push_back({ray.cast<float>(), static_cast<float>(near / ray.z()), static_cast<float>(far / ray.z())});
    }
}

bool TruthCamera::isInside(const Eigen::Vector2d& pixel) const {
  return (pixel - round_.middle()).norm() <= round_.radius();  // false for NaN
}

void TruthCamera::look(const TruthScene& scene, const Eigen::Isometry3d& pose, TruthView& view) const {
  view.pose = pose;
  const Eigen::Matrix3f turn = pose.linear().cast<float>();
  std::vector<CameraRay> rays(rays_);
  for (CameraRay& ray : rays) ray.direction = turn * ray.direction;
  scene.rays().firstHits(pose.translation().cast<float>(), rays, view.hits);
  view.shapes.resize(scene.bodyCount());
  for (std::uint32_t body = 0; body < view.shapes.size(); ++body) view.shapes[body] = scene.shapeNumber(body);
}

std::vector<float> TruthCamera::depth(const TruthScene& scene, const TruthView& view) const {
  std::vector<float> image(pixelCount(), kNone);
  const Eigen::Vector3d ahead = view.pose.linear().col(2), origin = view.pose.translation();
  for (std::size_t k = 0; k < pixels_.size(); ++k)
    if (view.hits[k].any()) image[pixels_[k]] = static_cast<float>(ahead.dot(scene.placeOf(view.hits[k]) - origin));
  return image;
}

std::vector<float> TruthCamera::normals(const TruthScene& scene, const TruthView& view) const {
  std::vector<float> image(3 * pixelCount(), kNone);
  const Eigen::Matrix3d turn = view.pose.linear();
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    if (!view.hits[k].any()) continue;
    const Eigen::Vector3d towards = -(turn * rays_[k].direction.cast<double>());
    const Eigen::Vector3f normal = (turn.transpose() * scene.normalOf(view.hits[k], towards)).cast<float>();
    std::copy_n(normal.data(), 3, &image[3 * pixels_[k]]);
  }
  return image;
}

std::vector<std::uint8_t> TruthCamera::labels(const TruthScene& scene, const TruthView& view) const {
  std::vector<std::uint8_t> image(pixelCount(), kLabelNothing);
  for (std::size_t k = 0; k < pixels_.size(); ++k)
    if (view.hits[k].any())
      image[pixels_[k]] = scene.labelOf(view.hits[k], -(view.pose.linear() * rays_[k].direction.cast<double>()));
  return image;
}

TruthFlow TruthCamera::flow(const TruthView& before, const TruthScene& scene, const Eigen::Isometry3d& pose) const {
  TruthFlow flow;
  flow.motion.assign(2 * pixelCount(), kNone);
  flow.visible.assign(pixelCount(), 0);
  std::vector<std::uint32_t> moved;
  std::vector<CameraRay> rays;
  const Eigen::Isometry3d to_camera = pose.inverse(Eigen::Isometry);
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    const SurfaceHit& hit = before.hits[k];
    if (!hit.any() || before.shapes[hit.body] == 0 || before.shapes[hit.body] != scene.shapeNumber(hit.body)) continue;
    const Eigen::Vector3d place = scene.placeOf(hit), seen = to_camera * place;
    if (!(seen.z() >= near_ && seen.z() <= far_)) continue;
    const Eigen::Vector2d pixel = pixelOf(round_, seen);
    if (!isInside(pixel)) continue;
    const int at = static_cast<int>(pixels_[k]);
    const Eigen::Vector2f motion = (pixel - Eigen::Vector2d(at % round_.width, at / round_.width)).cast<float>();
    std::copy_n(motion.data(), 2, &flow.motion[2 * pixels_[k]]);
    moved.push_back(pixels_[k]);
    const Eigen::Vector3d ray = place - pose.translation();
    const double distance = ray.norm();
    rays.push_back({(ray / distance).cast<float>(), static_cast<float>(near_ * distance / seen.z()),
                    static_cast<float>((1 - kShortened) * distance)});
  }
  hide(moved, rays, scene, pose.translation(), flow.visible);
  return flow;
}

void TruthCamera::hide(const std::vector<std::uint32_t>& pixels, const std::vector<CameraRay>& rays,
                       const TruthScene& scene, const Eigen::Vector3d& origin,
                       std::vector<std::uint8_t>& visible) const {
  std::vector<std::uint8_t> blocked;
  scene.rays().areBlocked(origin.cast<float>(), rays, blocked);
  for (std::size_t k = 0; k < pixels.size(); ++k)
    visible[pixels[k]] = blocked[k] != 0 ? TruthFlow::kHiddenNext : TruthFlow::kVisibleNext;
}

}  // namespace vibe
