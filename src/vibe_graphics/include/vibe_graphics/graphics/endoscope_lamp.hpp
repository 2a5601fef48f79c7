#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include <OgreVector3.h>

#include "vibe_graphics/geometry/capsule_fit.hpp"
#include "vibe_graphics/geometry/endoscope_optics.hpp"

namespace Ogre {
class Camera;
class Mesh;
class SceneManager;
}  // namespace Ogre

namespace vibe::graphics {

/// The light of media/lamp.glsl: parameters that all materials share which it lights, and all scenes of the process.

/// Creates the parameters with the default light; to be called before the materials are loaded. For loadResources(),
/// once.
void provideLamp();

/// From the next picture on everything is lit by this light. To be called after loadResources().
void setLamp(const EndoscopeLight& light);

/// Whether the light is the default, for which shaders may use constants.
bool isUsualLamp();

/// Where the guides are now, in view coordinates of Ogre [m].
std::array<Ogre::Vector3, 2> guidePlaces();

/// Tells the mucosa's shader what stands between the light guides and the wall: the meshes of robots before the lens,
/// as capsules in view coordinates (media/shadow.glsl). The shader's parameters are shared by all materials; cast() is
/// therefore to be called just before a picture is drawn.
class DeviceShadow {
 public:
  /// Creates the shared parameters; to be called before the materials are loaded. For loadResources(), once.
  static void provide();

  /// @param visibility  mask of the viewport
  void cast(Ogre::SceneManager& scene, const Ogre::Camera& camera, std::uint32_t visibility);

 private:
  const std::vector<Capsule>& capsulesOf(const Ogre::Mesh& mesh);

  std::map<std::uint64_t, std::vector<Capsule>> known_;  // by the handle of the mesh
};

}  // namespace vibe::graphics
