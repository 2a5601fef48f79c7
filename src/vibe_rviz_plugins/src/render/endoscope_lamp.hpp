#pragma once
#include <OgreVector3.h>

#include <array>

#include "geometry/endoscope_light.hpp"

namespace vibe::rviz_plugins {

/// The light of media/lamp.glsl: parameters that all materials share which it lights, and all scenes of the process.

/// Creates the parameters with the default light; to be called before the materials are loaded. For loadResources(),
/// once.
void provideLamp();

/// From the next picture on everything is lit by this light. To be called after loadResources().
void setLamp(const EndoscopeLight& light);

/// Whether the light is the default, for which shaders may use constants.
bool isUsualLamp();

/// Where the guides are now, in view coordinates of Ogre [m].
std::array<Ogre::Vector3, 2> guidePlaces();

}  // namespace vibe::rviz_plugins
