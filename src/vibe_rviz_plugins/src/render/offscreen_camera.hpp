#pragma once
#include <OgreTexture.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/lens.hpp"

namespace Ogre {
class Camera;
class SceneManager;
}  // namespace Ogre

namespace vibe {

class EndoscopeLens;

/// Renders endoscope images of a scene into memory, without a window. To be used from the thread that renders.
class OffscreenCamera {
 public:
  /// @param scene      must outlive this object
  /// @param sharpness  as in sourceFor()
  /// @throws std::runtime_error  the graphics system cannot do it
  OffscreenCamera(Ogre::SceneManager& scene, const RoundCamera& round, double sharpness);
  ~OffscreenCamera();
  OffscreenCamera(const OffscreenCamera&) = delete;
  OffscreenCamera& operator=(const OffscreenCamera&) = delete;

  /// @param pose    of the optical frame (z forward, x right, y down) in the scene [m]
  /// @param pixels  result: red, green, blue of height rows of width pixels, from the top
  void take(const Eigen::Isometry3d& pose, std::vector<std::uint8_t>& pixels);

 private:
  Ogre::SceneManager& scene_;
  RoundCamera round_;
  double sharpness_;
  Ogre::Camera* camera_;
  Ogre::TexturePtr picture_;
  std::unique_ptr<EndoscopeLens> lens_;
};

}  // namespace vibe
