#include "vibe_graphics/graphics/resources.hpp"

#include <atomic>
#include <stdexcept>
#include <string>

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreResourceGroupManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <ros/package.h>

#include "vibe_graphics/geometry/mucosa_pattern.hpp"
#include "vibe_graphics/graphics/endoscope_lamp.hpp"
#include "vibe_graphics/graphics/endoscope_lens.hpp"

namespace vibe::graphics {

const char* const kResourceGroup = "vibe_graphics";
const char* const kEndoscopeScheme = "vibe_endoscope";

void loadResources() {
  auto& groups = Ogre::ResourceGroupManager::getSingleton();
  if (groups.resourceGroupExists(kResourceGroup)) return;
  const std::string package = ros::package::getPath("vibe_graphics");
  if (package.empty())
    throw std::runtime_error(
        "The package vibe_graphics is not in ROS_PACKAGE_PATH; source devel/setup.bash before rviz.");
  groups.createResourceGroup(kResourceGroup);
  groups.addResourceLocation(package + "/media", "FileSystem", kResourceGroup);
  provideMucosaTexture();  // a material of the group reads it
  provideLamp();
  DeviceShadow::provide();
  EndoscopeLens::provide();
  groups.initialiseResourceGroup(kResourceGroup);
  dressMeshesForEndoscope();
}

std::string uniqueName(const std::string& what) {
  static std::atomic<unsigned> count{0};
  return "vibe" + what + std::to_string(count++);
}

Ogre::MaterialPtr copyMaterial(const std::string& name) {
  loadResources();
  Ogre::MaterialPtr original = Ogre::MaterialManager::getSingleton().getByName(name, kResourceGroup);
  if (!original) throw std::runtime_error("There is no material '" + name + "' in media/ of vibe_graphics.");
  Ogre::MaterialPtr copy = original->clone(uniqueName(name), true, kResourceGroup);
  copy->load();
  return copy;
}

void dropMaterial(Ogre::MaterialPtr& material) {
  if (material) Ogre::MaterialManager::getSingleton().remove(material);
  material.reset();
}

namespace {

const char* const kLook = "vibe/instrument";

Ogre::Technique* dressed(Ogre::Material& material, const Ogre::Material& look) {
  const Ogre::Pass& plain = *material.getTechnique(0)->getPass(0);
  const Ogre::ColourValue colour = plain.getDiffuse();
  const Ogre::Real shine = plain.getSpecular().r, sharpness = plain.getShininess();
  Ogre::Technique* technique = material.createTechnique();
  *technique = *look.getTechnique(0);
  Ogre::GpuProgramParameters& uniforms = *technique->getPass(0)->getFragmentProgramParameters();
  uniforms.setNamedConstant("colour", Ogre::Vector3(colour.r, colour.g, colour.b));
  uniforms.setNamedConstant("shine", shine);
  uniforms.setNamedConstant("sharpness", sharpness > 1 ? sharpness : Ogre::Real(1));
  material.compile();
  return technique->isSupported() ? technique : nullptr;
}

/// Asked by Ogre once for each material that has no technique of the scheme.
class Wardrobe : public Ogre::MaterialManager::Listener {
 public:
  Ogre::Technique* handleSchemeNotFound(unsigned short, const Ogre::String&, Ogre::Material* material, unsigned short,
                                        const Ogre::Renderable*) override {
    if (!isMeshOfRobot(*material)) return nullptr;
    const Ogre::MaterialPtr look = Ogre::MaterialManager::getSingleton().getByName(kLook, kResourceGroup);
    return look ? dressed(*material, *look) : nullptr;
  }
};

}  // namespace

bool isMeshOfRobot(const Ogre::Material& material) {
  return material.getName().find("://") != std::string::npos;  // the address of its file and a number
}

void dressMeshesForEndoscope() {
  static Wardrobe wardrobe;
  Ogre::MaterialManager::getSingleton().addListener(&wardrobe, kEndoscopeScheme);
}

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

}  // namespace vibe::graphics
