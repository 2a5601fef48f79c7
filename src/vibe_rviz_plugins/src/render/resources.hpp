#pragma once
#include <OgreMaterial.h>

#include <string>

namespace vibe {

/// Ogre's resource group of this package: materials and shaders of media/ and everything made at run time.
extern const char* const kResourceGroup;
/// Material scheme of a viewport that shows what the endoscope sees: its own light, no sight through walls from inside.
extern const char* const kEndoscopeScheme;

/// Makes the materials of this package known to Ogre, once. To be called first by everything that draws, after Ogre has
/// a render window.
/// @throws std::runtime_error  the package's media folder cannot be found
void loadResources();

/// A name that nothing else in this process has.
std::string uniqueName(const std::string& what);

/// A copy of a material of media/vibe.material, so that one display's settings do not change another's. The caller
/// removes it with dropMaterial().
/// @throws std::runtime_error  there is no such material
Ogre::MaterialPtr copyMaterial(const std::string& name);
void dropMaterial(Ogre::MaterialPtr& material);

}  // namespace vibe
