#pragma once
#include <OgreMaterial.h>

#include <string>

namespace vibe::rviz_plugins {

/// Resource group of this package in Ogre: materials and shaders of media/ and everything created at run time.
extern const char* const kResourceGroup;
/// Material scheme of the endoscope view: lit by its own lamp, walls opaque from inside.
extern const char* const kEndoscopeScheme;

/// Registers the materials of this package with Ogre, once. Call it before drawing, after Ogre has a render window.
/// @throws std::runtime_error  the package's media folder cannot be found
void loadResources();

/// A name that is unique in this process.
std::string uniqueName(const std::string& what);

/// A copy of a material of media/vibe.material, so that one display's settings do not change another's. The caller
/// removes it with dropMaterial().
/// @throws std::runtime_error  there is no such material
Ogre::MaterialPtr copyMaterial(const std::string& name);
void dropMaterial(Ogre::MaterialPtr& material);

}  // namespace vibe::rviz_plugins
