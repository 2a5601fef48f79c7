#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "truth/truth_scene.hpp"
#include "vibe_graphics/geometry/endoscope_optics.hpp"

namespace vibe::endoscope {

/// What a camera has seen at one moment: for each pixel in the circle the point of a surface, as material coordinates.
struct TruthView {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the optical frame in the frame of the scene [m]
  std::vector<SurfaceHit> hits;                            ///< one per pixel in the circle, in an order of the camera
  std::vector<std::uint64_t> shapes;                       ///< shape number per body, as TruthScene tells it
};

/// Where the points of one view went by the time of the next one.
struct TruthFlow {
  /// x y per pixel of the image: from the pixel to the place of the same material point in the next image [px]; NaN
  /// where nothing was seen, where points are not material (blood), and where the point leaves the image.
  std::vector<float> motion;
  /// Per pixel: 0 no motion is given, kHiddenNext the point is hidden in the next image, kVisibleNext it is visible.
  std::vector<std::uint8_t> visible;
  static constexpr std::uint8_t kHiddenNext = 128, kVisibleNext = 255;
};

/// Images of the truth, by one ray through the centre of each pixel. All images have the size of the camera, rows from
/// the top; NaN or 0 where there is nothing to tell. Frame: z forward, x right, y down.
class TruthCamera {
 public:
  /// @param near, far  along the optical axis: rigid bodies before, and everything beyond, are not seen [m]
  TruthCamera(const graphics::RoundCamera& round, double near, double far);

  const graphics::RoundCamera& round() const { return round_; }

  /// Casts the rays; the scene must be committed.
  void look(const TruthScene& scene, const Eigen::Isometry3d& pose, TruthView& view) const;

  // The scene must be as it was when the view was taken.

  /// Distance along the optical axis [m] (REP-118).
  std::vector<float> depth(const TruthScene& scene, const TruthView& view) const;
  /// x y z per pixel: unit normals towards the camera in its frame, as TruthScene::normalOf().
  std::vector<float> normals(const TruthScene& scene, const TruthView& view) const;
  std::vector<std::uint8_t> labels(const TruthScene& scene, const TruthView& view) const;

  /// @param before  an earlier view of this camera
  /// @param scene   as it is now, committed
  /// @param pose    of the camera now
  TruthFlow flow(const TruthView& before, const TruthScene& scene, const Eigen::Isometry3d& pose) const;

 private:
  bool isInside(const Eigen::Vector2d& pixel) const;
  void addPixel(int x, int y);
  std::size_t pixelCount() const { return static_cast<std::size_t>(round_.width) * round_.height; }
  void hide(const std::vector<std::uint32_t>& pixels, const std::vector<CameraRay>& rays, const TruthScene& scene,
            const Eigen::Isometry3d& pose, std::vector<std::uint8_t>& visible) const;

  graphics::RoundCamera round_;
  double near_, far_;
  std::vector<std::uint32_t> pixels_;  // in the circle: row * width + column; tile by tile
  std::vector<CameraRay> rays_;        // of these pixels, in the frame of the camera
};

}  // namespace vibe::endoscope
