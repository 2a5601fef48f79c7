#include "vibe_graphics/graphics/offscreen_camera.hpp"

#include <OgreCamera.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreRenderTexture.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTextureManager.h>
#include <OgreViewport.h>

#include "vibe_graphics/graphics/endoscope_lens.hpp"
#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {

OffscreenCamera::OffscreenCamera(Ogre::SceneManager& scene, const RoundCamera& round, double sharpness)
    : scene_(scene), round_(round), sharpness_(sharpness), camera_(scene.createCamera(uniqueName("Camera"))) {
  camera_->setNearClipDistance(kScopeNearClip);
  camera_->setFarClipDistance(kScopeFarClip);
  scene_.getRootSceneNode()->createChildSceneNode()->attachObject(camera_);
  picture_ = Ogre::TextureManager::getSingleton().createManual(
      uniqueName("Picture"), kResourceGroup, Ogre::TEX_TYPE_2D, static_cast<Ogre::uint>(round.width),
      static_cast<Ogre::uint>(round.height), 0, Ogre::PF_BYTE_RGBA, Ogre::TU_RENDERTARGET);
  Ogre::RenderTarget& target = *picture_->getBuffer()->getRenderTarget();
  target.setAutoUpdated(false);
  Ogre::Viewport& viewport = *target.addViewport(camera_);
  viewport.setBackgroundColour(Ogre::ColourValue::Black);
  viewport.setOverlaysEnabled(false);
  lens_ = std::make_unique<EndoscopeLens>(viewport);
  lens_->set(round_.lens, round_.field_of_view, sharpness_);
}

OffscreenCamera::~OffscreenCamera() {
  lens_.reset();
  Ogre::TextureManager::getSingleton().remove(picture_);
  Ogre::SceneNode* node = camera_->getParentSceneNode();
  scene_.destroyCamera(camera_);
  scene_.destroySceneNode(node);
}

void OffscreenCamera::place(const Eigen::Isometry3d& pose) {
  auto real = [](double value) { return static_cast<Ogre::Real>(value); };
  const Eigen::Vector3d& place = pose.translation();
  const Eigen::Quaterniond turn(pose.linear());
  camera_->getParentSceneNode()->setPosition(real(place.x()), real(place.y()), real(place.z()));
  camera_->getParentSceneNode()->setOrientation(
      Ogre::Quaternion(real(turn.w()), real(turn.x()), real(turn.y()), real(turn.z())) * opticalToOgre());
  lens_->set(round_.lens, round_.field_of_view, sharpness_);
}

void OffscreenCamera::draw(double gain) {
  lens_->setGain(gain);
  picture_->getBuffer()->getRenderTarget()->update();
}

void OffscreenCamera::read(std::vector<std::uint8_t>& pixels) {
  const auto width = static_cast<Ogre::uint32>(round_.width), height = static_cast<Ogre::uint32>(round_.height);
  pixels.resize(std::size_t{3} * width * height);
  picture_->getBuffer()->blitToMemory(Ogre::PixelBox(width, height, 1, Ogre::PF_BYTE_RGB, pixels.data()));
}

void OffscreenCamera::take(const Eigen::Isometry3d& pose, std::vector<std::uint8_t>& pixels) {
  place(pose);
  draw(AutoExposure::kFixedGain);
  read(pixels);
}

void OffscreenCamera::take(const Eigen::Isometry3d& pose, double time, std::vector<std::uint8_t>& pixels) {
  place(pose);
  const bool other_eye = time == time_;  // of a stereo pair: both are exposed alike
  if (other_eye) draw(gain_);
  for (bool lost = !other_eye; lost; lost = exposure_.isLost()) {
    gain_ = exposure_.gain(), time_ = time;
    draw(gain_);
    const std::optional<double> level = lens_->level();
    if (!level) break;
    exposure_.see(*level, time);
  }
  read(pixels);
}

}  // namespace vibe::graphics
