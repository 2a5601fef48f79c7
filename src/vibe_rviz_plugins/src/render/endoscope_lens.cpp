#include "render/endoscope_lens.hpp"

#include <OgreCamera.h>
#include <OgreCompositionPass.h>
#include <OgreCompositionTargetPass.h>
#include <OgreCompositionTechnique.h>
#include <OgreCompositor.h>
#include <OgreCompositorManager.h>
#include <OgreLight.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>
#include <OgreViewport.h>

#include <cmath>
#include <stdexcept>

#include "render/resources.hpp"

namespace vibe {
namespace {

constexpr int kMaxSource = 4096;  // what every graphics card can do [px]
constexpr float kReach = 0.06f;   // of the lamp, as in media/vibe.material: distance of half intensity [m]
const char* const kSource = "source";

void drawScene(Ogre::CompositionTechnique& technique, std::uint32_t visibility) {
  Ogre::CompositionTargetPass& target = *technique.createTargetPass();
  target.setOutputName(kSource);
  target.setInputMode(Ogre::CompositionTargetPass::IM_NONE);
  target.setMaterialScheme(kEndoscopeScheme);
  target.setVisibilityMask(visibility);
  target.setShadowsEnabled(false);
  Ogre::CompositionPass& clear = *target.createPass();
  clear.setType(Ogre::CompositionPass::PT_CLEAR);
  clear.setClearColour(Ogre::ColourValue::Black);
  target.createPass()->setType(Ogre::CompositionPass::PT_RENDERSCENE);
}

void drawBent(Ogre::CompositionTechnique& technique, const Ogre::MaterialPtr& material) {
  Ogre::CompositionTargetPass& target = *technique.getOutputTargetPass();
  target.setInputMode(Ogre::CompositionTargetPass::IM_NONE);
  Ogre::CompositionPass& quad = *target.createPass();
  quad.setType(Ogre::CompositionPass::PT_RENDERQUAD);
  quad.setMaterial(material);
  quad.setInput(0, kSource);
}

}  // namespace

EndoscopeLens::EndoscopeLens(Ogre::Viewport& viewport) : viewport_(&viewport) {
  viewport_->addListener(this);
}

EndoscopeLens::~EndoscopeLens() {
  remove();
  if (viewport_ != nullptr) viewport_->removeListener(this);
}

// Ogre removes the compositors of the viewport itself.
void EndoscopeLens::viewportDestroyed(Ogre::Viewport*) {
  viewport_ = nullptr;
}

void EndoscopeLens::set(LensKind lens, double field_of_view, double sharpness) {
  if (viewport_ == nullptr) return;
  const RoundCamera wanted{lens, field_of_view, viewport_->getActualWidth(), viewport_->getActualHeight()};
  if (!problemOf(wanted).empty()) return remove();  // the window is too small to show anything
  const bool same = !name_.empty() && sharpness == sharpness_ && wanted.lens == camera_.lens &&
                    wanted.field_of_view == camera_.field_of_view && wanted.width == camera_.width &&
                    wanted.height == camera_.height;
  if (!same) {
    remove();
    camera_ = wanted;
    sharpness_ = sharpness;
    source_ = sourceFor(camera_, sharpness, kMaxSource);
    make(source_);
  }
  // each time, because the owner of the viewport adapts the camera to the window
  Ogre::Camera* eye = viewport_->getCamera();
  eye->setAspectRatio(1);
  eye->setFOVy(Ogre::Radian(static_cast<Ogre::Real>(2 * std::atan(source_.half_width))));
  lamp_->setPosition(eye->getDerivedPosition());
}

void EndoscopeLens::remove() {
  if (name_.empty()) return;
  auto& manager = Ogre::CompositorManager::getSingleton();
  if (viewport_ != nullptr) manager.removeCompositor(viewport_, name_);
  manager.remove(name_, kResourceGroup);
  dropMaterial(material_);
  name_.clear();
  Ogre::SceneManager* scene = lamp_->getCreator();
  scene->destroyLight(static_cast<Ogre::Light*>(lamp_->getAttachedObject(0)));
  scene->destroySceneNode(lamp_);
  lamp_ = nullptr;
}

void EndoscopeLens::light() {
  Ogre::SceneManager* scene = viewport_->getCamera()->getSceneManager();
  Ogre::Light* lamp = scene->createLight(uniqueName("Lamp"));
  lamp->setType(Ogre::Light::LT_POINT);
  lamp->setDiffuseColour(0.6f, 0.6f, 0.6f);
  lamp->setSpecularColour(0.3f, 0.3f, 0.3f);
  lamp->setAttenuation(1, 0.5f, 0, 0.5f / (kReach * kReach));
  lamp_ = scene->getRootSceneNode()->createChildSceneNode();
  lamp_->attachObject(lamp);
}

void EndoscopeLens::make(const SquareSource& source) {
  auto& manager = Ogre::CompositorManager::getSingleton();
  material_ = copyMaterial("vibe/endoscope_lens");
  setMaterial(source);
  name_ = uniqueName("Lens");
  Ogre::CompositionTechnique& technique = *manager.create(name_, kResourceGroup)->createTechnique();
  auto& texture = *technique.createTextureDefinition(kSource);
  texture.width = texture.height = static_cast<std::uint32_t>(source.size);
  texture.formatList.push_back(Ogre::PF_BYTE_RGBA);
  texture.fsaa = false;  // the lens blends neighbours anyway
  drawScene(technique, viewport_->getVisibilityMask());
  drawBent(technique, material_);
  if (manager.addCompositor(viewport_, name_) == nullptr) {
    manager.remove(name_, kResourceGroup);
    name_.clear();
    throw std::runtime_error("The graphics card cannot draw the endoscope's view; choose another view.");
  }
  manager.setCompositorEnabled(viewport_, name_, true);
  light();
}

void EndoscopeLens::setMaterial(const SquareSource& source) {
  auto real = [](double value) { return static_cast<Ogre::Real>(value); };
  Ogre::GpuProgramParameters& uniforms = *material_->getTechnique(0)->getPass(0)->getFragmentProgramParameters();
  uniforms.setNamedConstant("picture_size", Ogre::Vector2(real(camera_.width), real(camera_.height)));
  uniforms.setNamedConstant("radius", real(camera_.radius()));
  uniforms.setNamedConstant("half_angle", real(0.5 * camera_.field_of_view));
  uniforms.setNamedConstant("equidistant", real(camera_.lens == LensKind::Equidistant ? 1 : 0));
  uniforms.setNamedConstant("source_half_width", real(source.half_width));
  uniforms.setNamedConstant("source_size", real(source.size));
}

}  // namespace vibe
