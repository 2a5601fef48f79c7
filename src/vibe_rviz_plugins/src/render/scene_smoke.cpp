#include "render/scene_smoke.hpp"

#include <OgreSceneManager.h>

#include <cmath>

namespace vibe::rviz_plugins {
namespace {

constexpr double kSteps = 256;  // per 1/m: sums of such numbers are exact, so smoke that is gone leaves nothing

}  // namespace

void SceneSmoke::set(double extinction, double time) {
  const auto now = static_cast<float>(std::round(kSteps * extinction) / kSteps);
  const float sum = scene_.getFogDensity() - extinction_ + now;
  extinction_ = now;
  // no fog mode, only the numbers: shaders read density and begin as smoke.x and smoke.y
  scene_.setFog(Ogre::FOG_NONE, Ogre::ColourValue::White, sum, static_cast<float>(time));
}

}  // namespace vibe::rviz_plugins
