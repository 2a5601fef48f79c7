#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <OgreQuaternion.h>
#include <OgreTexture.h>
#include <Eigen/Geometry>

#include "vibe_graphics/geometry/endoscope_optics.hpp"

namespace Ogre {
class Camera;
class SceneManager;
}  // namespace Ogre

namespace vibe::graphics {

constexpr float kScopeNearClip = 0.0006f;  ///< near clipping distance; the glass of the lens is 0.4 mm thick [m]
constexpr float kScopeFarClip = 2;         ///< far clipping distance, beyond any tissue [m]

/// Turns a camera of Ogre (z backward, x right, y up) so that it looks along an optical frame (z forward, x right,
/// y down): orientation of the camera = orientation of the frame * this.
inline Ogre::Quaternion opticalToOgre() {
  return {0, 1, 0, 0};
}

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
  /// The same with automatic exposure.
  /// @param time  of the picture; one after a gap, or after time was set back, is exposed anew, and one with the same
  ///              time as the one before like it [s]
  void take(const Eigen::Isometry3d& pose, double time, std::vector<std::uint8_t>& pixels);
  double gain() const { return gain_; }  ///< of the last picture with automatic exposure

 private:
  void place(const Eigen::Isometry3d& pose);
  void draw(double gain);
  void read(std::vector<std::uint8_t>& pixels);

  Ogre::SceneManager& scene_;
  RoundCamera round_;
  double sharpness_;
  Ogre::Camera* camera_;
  Ogre::TexturePtr picture_;
  std::unique_ptr<EndoscopeLens> lens_;
  AutoExposure exposure_;
  double gain_ = AutoExposure::kFixedGain, time_ = -1;  ///< of the last picture; time: [s]
};

}  // namespace vibe::graphics
