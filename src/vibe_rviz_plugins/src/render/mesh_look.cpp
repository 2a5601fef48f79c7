#include "render/mesh_look.hpp"

#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreTechnique.h>

#include <string>

#include "render/resources.hpp"

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
