#pragma once

namespace Ogre {
class SceneManager;
}  // namespace Ogre

namespace vibe::rviz_plugins {

/// The smoke of one organ in a scene; its shaders see the sum over all organs. It is a setting of the scene, its
/// density of fog, because the light through it changes on everything that an endoscope sees, meshes of other displays
/// too. Fixed-function materials stay without fog.
class SceneSmoke {
 public:
  /// @param scene  must outlive this object
  explicit SceneSmoke(Ogre::SceneManager& scene) : scene_(scene) {}
  ~SceneSmoke() { set(0, 0); }
  SceneSmoke(const SceneSmoke&) = delete;
  SceneSmoke& operator=(const SceneSmoke&) = delete;

  /// @param extinction  of light, rounded to 1/256 [1/m]
  /// @param time        at which its wisps are seen [s]
  void set(double extinction, double time);

 private:
  Ogre::SceneManager& scene_;
  float extinction_ = 0;  // as it is part of the sum
};

}  // namespace vibe::rviz_plugins
