#pragma once

#include <string>

#include <OgreMaterial.h>

namespace vibe::graphics {

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
void dropMaterial(Ogre::MaterialPtr& material);  ///< null afterwards; nothing happens if it is already

/// Whether rviz has made the material for a mesh of a robot.
bool isMeshOfRobot(const Ogre::Material& material);

/// From now on the meshes of robots, which know only rviz's light, have the look of vibe/instrument where the endoscope
/// sees them (scheme kEndoscopeScheme): in rviz's endoscope view as in the image of endoscope_camera. Colour,
/// highlights and their sharpness are those of the mesh file. For loadResources(), once per process.
void dressMeshesForEndoscope();

/// Makes the solid texture that the shader of the mucosa reads (geometry/mucosa_pattern.hpp), once per process.
/// @return  its name in the resource group of this package
/// @throws std::runtime_error  the graphics system has no solid textures
const std::string& provideMucosaTexture();

}  // namespace vibe::graphics
