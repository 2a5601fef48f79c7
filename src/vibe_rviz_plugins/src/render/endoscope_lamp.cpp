#include "render/endoscope_lamp.hpp"

#include <OgreGpuProgramManager.h>

#include <algorithm>
#include <utility>

namespace vibe::rviz_plugins {
namespace {

const char* const kLampParameters = "vibe_lamp";  // as in media/*.program
constexpr std::array<const char*, 2> kGuides{"right_guide", "left_guide"};

Ogre::GpuSharedParametersPtr shared() {
  return Ogre::GpuProgramManager::getSingleton().getSharedParameters(kLampParameters);
}

const float* valuesOf(const char* name) {
  const Ogre::GpuSharedParametersPtr parameters = shared();
  const std::size_t place = parameters->getConstantDefinition(name).physicalIndex;
  return std::as_const(*parameters).getFloatPointer(place);
}

}  // namespace

void provideLamp() {
  const auto parameters = Ogre::GpuProgramManager::getSingleton().createSharedParameters(kLampParameters);
  for (const char* guide : kGuides) parameters->addConstantDefinition(guide, Ogre::GCT_FLOAT4);
  parameters->addConstantDefinition("lamp_ahead", Ogre::GCT_FLOAT2);
  parameters->addConstantDefinition("lamp_colour", Ogre::GCT_FLOAT3);
  setLamp({});
}

void setLamp(const EndoscopeLight& light) {
  const auto parameters = shared();
  std::array<float, 2> ahead{};
  for (std::size_t k = 0; k < 2; ++k) {
    const LightGuide& guide = light.guides[k];
    const Eigen::Vector2d cone = coneOf(light, guide);
    const Eigen::Vector4f packed = Eigen::Vector4d(guide.right, guide.up, 0, cone.x()).cast<float>();
    parameters->setNamedConstant(kGuides[k], packed.data(), 4);
    ahead[k] = static_cast<float>(cone.y());
  }
  const Eigen::Vector3f colour = lightColour(light.temperature).cast<float>();
  parameters->setNamedConstant("lamp_ahead", ahead.data(), ahead.size());
  parameters->setNamedConstant("lamp_colour", colour.data(), 3);
}

bool isUsualLamp() {
  const EndoscopeLight usual;
  const float ahead = static_cast<float>(coneOf(usual, usual.guides[0]).y());
  for (std::size_t k = 0; k < 2; ++k) {
    const LightGuide& guide = usual.guides[k];
    const Eigen::Vector4f packed = Eigen::Vector4d(guide.right, guide.up, 0, coneOf(usual, guide).x()).cast<float>();
    if (!std::equal(packed.data(), packed.data() + 4, valuesOf(kGuides[k])) || valuesOf("lamp_ahead")[k] != ahead)
      return false;
  }
  const float* colour = valuesOf("lamp_colour");
  return std::all_of(colour, colour + 3, [](float value) { return value == 1; });
}

std::array<Ogre::Vector3, 2> guidePlaces() {
  return {Ogre::Vector3(valuesOf(kGuides[0])), Ogre::Vector3(valuesOf(kGuides[1]))};
}

}  // namespace vibe::rviz_plugins
