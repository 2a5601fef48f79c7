#include "render/mucosa_texture.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreTextureManager.h>

#include <stdexcept>

#include "geometry/mucosa_pattern.hpp"
#include "render/resources.hpp"

namespace vibe::rviz_plugins {

const std::string& provideMucosaTexture() {
  static const std::string name = "vibe/mucosa_pattern";
  auto& textures = Ogre::TextureManager::getSingleton();
  if (textures.resourceExists(name, kResourceGroup)) return name;
  MucosaPattern pattern = makeMucosaPattern();
  int levels = 0;
  while (pattern.size >> (levels + 1) > 0) ++levels;
  const auto size = static_cast<Ogre::uint>(pattern.size);
  const Ogre::TexturePtr texture = textures.createManual(name, kResourceGroup, Ogre::TEX_TYPE_3D, size, size, size,
                                                         levels, Ogre::PF_BYTE_RGBA, Ogre::TU_STATIC_WRITE_ONLY);
  if (!texture || texture->getNumMipmaps() != static_cast<Ogre::uint32>(levels))
    throw std::runtime_error("The graphics system has no solid textures with mipmaps, which the mucosa needs.");
  for (int level = 0; level <= levels; ++level) {
    const auto edge = static_cast<Ogre::uint32>(pattern.size);
    texture->getBuffer(0, static_cast<std::size_t>(level))
        ->blitFromMemory(Ogre::PixelBox(edge, edge, edge, Ogre::PF_BYTE_RGBA, pattern.voxels.data()));
    if (level < levels) pattern = halved(pattern);
  }
  return name;
}

}  // namespace vibe::rviz_plugins
