#include "render/endoscope_lamp.hpp"

#include <OgreGpuProgramManager.h>

namespace vibe {
namespace {

const char* const kParameters = "vibe_lamp";  // as in media/*.program

Ogre::GpuSharedParametersPtr shared() {
  return Ogre::GpuProgramManager::getSingleton().getSharedParameters(kParameters);
}

}  // namespace

void provideLamp() {
  const auto parameters = Ogre::GpuProgramManager::getSingleton().createSharedParameters(kParameters);
  parameters->addConstantDefinition("guides", Ogre::GCT_FLOAT4, 2);
  parameters->addConstantDefinition("lamp_ahead", Ogre::GCT_FLOAT2);
  parameters->addConstantDefinition("lamp_colour", Ogre::GCT_FLOAT3);
  setLamp({});
}

void setLamp(const EndoscopeLight& light) {
  std::array<float, 8> guides{};
  std::array<float, 2> ahead{};
  for (std::size_t k = 0; k < 2; ++k) {
    const LightGuide& guide = light.guides[k];
    const Eigen::Vector2d cone = coneOf(light, guide);
    const Eigen::Vector4f packed = Eigen::Vector4d(guide.right, guide.up, 0, cone.x()).cast<float>();
    std::copy_n(packed.data(), 4, &guides[4 * k]);
    ahead[k] = static_cast<float>(cone.y());
  }
  const Eigen::Vector3f colour = lightColour(light.temperature).cast<float>();
  const auto parameters = shared();
  parameters->setNamedConstant("guides", guides.data(), guides.size());
  parameters->setNamedConstant("lamp_ahead", ahead.data(), ahead.size());
  parameters->setNamedConstant("lamp_colour", colour.data(), 3);
}

std::array<Ogre::Vector3, 2> guidePlaces() {
  const auto parameters = shared();
  const float* values = parameters->getFloatPointer(parameters->getConstantDefinition("guides").physicalIndex);
  return {Ogre::Vector3(values), Ogre::Vector3(values + 4)};
}

}  // namespace vibe
