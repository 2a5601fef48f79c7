#include "vibe_graphics/graphics/endoscope_lens.hpp"

#include <OgreCamera.h>
#include <OgreCompositionPass.h>
#include <OgreCompositionTargetPass.h>
#include <OgreCompositionTechnique.h>
#include <OgreCompositor.h>
#include <OgreCompositorChain.h>
#include <OgreCompositorManager.h>
#include <OgreGpuProgramManager.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreLight.h>
#include <OgreRenderTexture.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>
#include <OgreTexture.h>
#include <OgreViewport.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {
namespace {

constexpr int kMaxSource = 4096;  // what every graphics card can do [px]
constexpr float kReach = 0.06f;   // of the lamp, as in media/vibe.material: distance of half intensity [m]
const char* const kSource = "source";
const char* const kMiddle = "middle";
const char* const kMeter = "meter";
constexpr int kMeterSize = 32;  // edge of the picture that measures the level [px]

const char* const kLensParameters = "vibe_lens";  // as in media/vibe.program
constexpr double kFirstBlend = 0.85;              // as in media/endoscope.frag

/// Share of half of the picture of the whole within which only that of the middle is shown, also in the picture of the
/// meter, and in small ones, where a pixel is the mean of a longer line.
double unseenShare(const RoundCamera& camera, const LensSources& sources) {
  if (sources.middle.size == 0) return 0;
  const double edge = kFirstBlend * sources.middle.half_width;
  const double line = (1 + edge * edge) * camera.field_of_view / std::min({kMeterSize, camera.width, camera.height});
  return std::max(0.0, edge - line) / sources.whole.half_width;
}

// Weight of a pixel at this share of the radius: centre-weighted metering, as video processors offer it.
double weightAt(double share) {
  return share > 1 ? 0 : 1 - 0.75 * share * share;
}

void drawScene(Ogre::CompositionTechnique& technique, const char* picture, std::uint32_t visibility) {
  Ogre::CompositionTargetPass& target = *technique.createTargetPass();
  target.setOutputName(picture);
  target.setInputMode(Ogre::CompositionTargetPass::IM_NONE);
  target.setMaterialScheme(kEndoscopeScheme);
  target.setVisibilityMask(visibility);
  target.setShadowsEnabled(false);
  Ogre::CompositionPass& clear = *target.createPass();
  clear.setType(Ogre::CompositionPass::PT_CLEAR);
  clear.setClearColour(Ogre::ColourValue::Black);
  target.createPass()->setType(Ogre::CompositionPass::PT_RENDERSCENE);
}

void drawBent(Ogre::CompositionTargetPass& target, const Ogre::MaterialPtr& material, const char* middle) {
  target.setInputMode(Ogre::CompositionTargetPass::IM_NONE);
  Ogre::CompositionPass& quad = *target.createPass();
  quad.setType(Ogre::CompositionPass::PT_RENDERQUAD);
  quad.setMaterial(material);
  quad.setInput(0, kSource);
  quad.setInput(1, middle);
}

void addTexture(Ogre::CompositionTechnique& technique, const char* name, int size, Ogre::PixelFormat format) {
  auto& texture = *technique.createTextureDefinition(name);
  texture.width = texture.height = static_cast<std::uint32_t>(size);
  texture.formatList.push_back(format);
  texture.fsaa = false;  // the lens blends neighbours anyway
}

}  // namespace

void EndoscopeLens::provide() {
  const auto shared = Ogre::GpuProgramManager::getSingleton().createSharedParameters(kLensParameters);
  shared->addConstantDefinition("unseen", Ogre::GCT_FLOAT1);
}

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
    sources_ = sourcesFor(camera_, sharpness, kMaxSource);
    make();
  }
  // each time, because the owner of the viewport adapts the camera to the window
  Ogre::Camera* eye = viewport_->getCamera();
  eye->setAspectRatio(1);
  setAngle(sources_.whole);
  lamp_->setPosition(eye->getDerivedPosition());
}

void EndoscopeLens::setAngle(const SquareSource& source) {
  if (viewport_ == nullptr) return;
  viewport_->getCamera()->setFOVy(Ogre::Radian(static_cast<Ogre::Real>(2 * std::atan(source.half_width))));
}

// Ogre draws with a copy of the material.
void EndoscopeLens::notifyMaterialRender(Ogre::uint32, Ogre::MaterialPtr& material) {
  const auto uniforms = material->getTechnique(0)->getPass(0)->getFragmentProgramParameters();
  uniforms->setNamedConstant("gain", static_cast<Ogre::Real>(gain_));
}

// Of the scene, before each of its pictures, also those of other cameras.
void EndoscopeLens::preFindVisibleObjects(Ogre::SceneManager* scene, Ogre::SceneManager::IlluminationRenderStage,
                                          Ogre::Viewport* viewport) {
  if (viewport_ == nullptr || viewport->getMaterialScheme() != kEndoscopeScheme) return;
  if (viewport->getCamera() != viewport_->getCamera()) return;
  shadow_.cast(*scene, *viewport->getCamera(), viewport->getVisibilityMask());
  const bool of_middle = middle_ && viewport->getTarget() == middle_->getBuffer()->getRenderTarget();
  const auto shared = Ogre::GpuProgramManager::getSingleton().getSharedParameters(kLensParameters);
  shared->setNamedConstant("unseen", static_cast<Ogre::Real>(of_middle ? 0 : unseenShare(camera_, sources_)));
}

std::optional<double> EndoscopeLens::level() const {
  if (name_.empty() || viewport_ == nullptr) return std::nullopt;
  auto& manager = Ogre::CompositorManager::getSingleton();
  Ogre::CompositorInstance* drawn = manager.getCompositorChain(viewport_)->getCompositor(name_);
  const Ogre::TexturePtr texture = drawn ? drawn->getTextureInstance(kMeter, 0) : nullptr;
  if (!texture) return std::nullopt;
  std::array<std::uint8_t, 3 * kMeterSize * kMeterSize> pixels;
  texture->getBuffer()->blitToMemory(Ogre::PixelBox(kMeterSize, kMeterSize, 1, Ogre::PF_BYTE_RGB, pixels.data()));
  double sum = 0, weights = 0;
  for (int y = 0; y < kMeterSize; ++y)
    for (int x = 0; x < kMeterSize; ++x) {
      const double weight =
          weightAt(std::hypot(x + 0.5 - 0.5 * kMeterSize, y + 0.5 - 0.5 * kMeterSize) / (0.5 * kMeterSize));
      const std::uint8_t* pixel = &pixels[static_cast<std::size_t>(3 * (y * kMeterSize + x))];
      sum += weight * (0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2]) / 255;  // ITU-R BT.601 luma
      weights += weight;
    }
  return sum / weights;
}

void EndoscopeLens::remove() {
  if (name_.empty()) return;
  // the texture may outlive this object, because materials hold it
  if (middle_) middle_->getBuffer()->getRenderTarget()->removeListener(this);
  middle_.reset();
  auto& manager = Ogre::CompositorManager::getSingleton();
  if (viewport_ != nullptr) manager.removeCompositor(viewport_, name_);
  manager.remove(name_, kResourceGroup);
  dropMaterial(material_), dropMaterial(meter_material_);
  name_.clear();
  Ogre::SceneManager* scene = lamp_->getCreator();
  scene->destroyLight(static_cast<Ogre::Light*>(lamp_->getAttachedObject(0)));
  scene->destroySceneNode(lamp_);
  scene->removeListener(this);
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
  scene->addListener(this);
}

void EndoscopeLens::addTargets(Ogre::CompositionTechnique& technique) {
  const bool two = sources_.middle.size > 0;
  // brighter than white before the exposure; 32 bits, because without a graphics card the way to 16 and back takes 4 ms
  addTexture(technique, kSource, sources_.whole.size, Ogre::PF_FLOAT32_RGBA);
  if (two) addTexture(technique, kMiddle, sources_.middle.size, Ogre::PF_FLOAT32_RGBA);
  addTexture(technique, kMeter, kMeterSize, Ogre::PF_BYTE_RGBA);
  drawScene(technique, kSource, viewport_->getVisibilityMask());
  if (two) drawScene(technique, kMiddle, viewport_->getVisibilityMask());
  Ogre::CompositionTargetPass& meter = *technique.createTargetPass();
  meter.setOutputName(kMeter);
  const char* const middle = two ? kMiddle : kSource;
  drawBent(meter, meter_material_, middle);
  drawBent(*technique.getOutputTargetPass(), material_, middle);
}

void EndoscopeLens::make() {
  auto& manager = Ogre::CompositorManager::getSingleton();
  material_ = copyMaterial("vibe/endoscope_lens");
  meter_material_ = copyMaterial("vibe/endoscope_lens");
  setMaterial(material_, camera_.width, camera_.height);
  setMaterial(meter_material_, kMeterSize, kMeterSize);
  name_ = uniqueName("Lens");
  addTargets(*manager.create(name_, kResourceGroup)->createTechnique());
  Ogre::CompositorInstance* drawn = manager.addCompositor(viewport_, name_);
  if (drawn == nullptr) {
    manager.remove(name_, kResourceGroup);
    name_.clear();
    throw std::runtime_error("The graphics card cannot draw the endoscope's view; choose another view.");
  }
  drawn->addListener(this);
  manager.setCompositorEnabled(viewport_, name_, true);
  if (sources_.middle.size > 0) {
    middle_ = drawn->getTextureInstance(kMiddle, 0);
    middle_->getBuffer()->getRenderTarget()->addListener(this);
  }
  light();
}

void EndoscopeLens::setMaterial(const Ogre::MaterialPtr& material, int width, int height) {
  auto real = [](double value) { return static_cast<Ogre::Real>(value); };
  Ogre::GpuProgramParameters& uniforms = *material->getTechnique(0)->getPass(0)->getFragmentProgramParameters();
  uniforms.setNamedConstant("picture_size", Ogre::Vector2(real(width), real(height)));
  uniforms.setNamedConstant("radius", real(0.5 * std::min(width, height)));
  uniforms.setNamedConstant("half_angle", real(0.5 * camera_.field_of_view));
  uniforms.setNamedConstant("equidistant", real(camera_.lens == LensKind::Equidistant ? 1 : 0));
  uniforms.setNamedConstant("source_half_width", real(sources_.whole.half_width));
  uniforms.setNamedConstant("source_size", real(sources_.whole.size));
  uniforms.setNamedConstant("middle_half_width", real(sources_.middle.half_width));
  uniforms.setNamedConstant("middle_size", real(sources_.middle.size));
}

}  // namespace vibe::graphics
