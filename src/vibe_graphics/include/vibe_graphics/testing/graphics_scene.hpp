#pragma once
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <rviz/ogre_helpers/render_system.h>

#include <cstdint>
#include <vector>

#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/graphics/virtual_display.hpp"

namespace vibe::graphics::test {

/// Red, green, blue of rows from the top.
using Pixels = std::vector<std::uint8_t>;

/// The one scene of a test program that draws. It needs no display. Lives until the program ends.
inline Ogre::SceneManager& graphicsScene() {
  static Ogre::SceneManager* scene = [] {
    provideDisplay();
    rviz::RenderSystem::forceNoStereo();
    Ogre::SceneManager* made = rviz::RenderSystem::get()->root()->createSceneManager();
    loadResources();
    return made;
  }();
  return *scene;
}

}  // namespace vibe::graphics::test
