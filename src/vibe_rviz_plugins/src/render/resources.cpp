#include "render/resources.hpp"

#include <OgreMaterialManager.h>
#include <OgreResourceGroupManager.h>
#include <OgreTechnique.h>
#include <ros/package.h>

#include <atomic>
#include <stdexcept>

#include "render/device_shadow.hpp"
#include "render/endoscope_lamp.hpp"
#include "render/endoscope_lens.hpp"
#include "render/mesh_look.hpp"
#include "render/mucosa_texture.hpp"

namespace vibe::rviz_plugins {

const char* const kResourceGroup = "vibe_rviz_plugins";
const char* const kEndoscopeScheme = "vibe_endoscope";

void loadResources() {
  auto& groups = Ogre::ResourceGroupManager::getSingleton();
  if (groups.resourceGroupExists(kResourceGroup)) return;
  const std::string package = ros::package::getPath("vibe_rviz_plugins");
  if (package.empty())
    throw std::runtime_error(
        "The package vibe_rviz_plugins is not in ROS_PACKAGE_PATH; source devel/setup.bash before rviz.");
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
  if (!original) throw std::runtime_error("There is no material '" + name + "' in media/ of vibe_rviz_plugins.");
  Ogre::MaterialPtr copy = original->clone(uniqueName(name), true, kResourceGroup);
  copy->load();
  return copy;
}

void dropMaterial(Ogre::MaterialPtr& material) {
  if (material) Ogre::MaterialManager::getSingleton().remove(material);
  material.reset();
}

}  // namespace vibe::rviz_plugins
