#pragma once

namespace Ogre {
class Material;
}

namespace vibe::rviz_plugins {

/// Whether rviz has made the material for a mesh of a robot.
bool isMeshOfRobot(const Ogre::Material& material);

/// From now on the meshes of robots, which know only rviz's light, have the look of vibe/instrument where the endoscope
/// sees them (scheme kEndoscopeScheme): in rviz's endoscope view as in the image of endoscope_camera. Colour,
/// highlights and their sharpness are those of the mesh file. For loadResources(), once per process.
void dressMeshesForEndoscope();

}  // namespace vibe::rviz_plugins
