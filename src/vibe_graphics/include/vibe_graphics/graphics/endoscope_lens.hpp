#pragma once
#include <OgreCompositorInstance.h>
#include <OgreMaterial.h>
#include <OgreRenderTargetListener.h>
#include <OgreSceneManager.h>
#include <OgreTexture.h>
#include <OgreViewport.h>

#include <optional>
#include <string>

#include "vibe_graphics/geometry/endoscope_optics.hpp"
#include "vibe_graphics/graphics/endoscope_lamp.hpp"

namespace Ogre {
class CompositionTechnique;
class SceneNode;
}  // namespace Ogre

namespace vibe::graphics {

/// Makes a viewport show the image of an endoscope: with the projection of its lens, black outside of a circle, and lit
/// by its lamp (scheme kEndoscopeScheme for materials of this package, a light in the scene for other materials). The
/// camera of the viewport must be at the lens; its angles are set here. The effect ends when this object or the
/// viewport is deleted; rviz deletes its window before its views. The scene must outlive this object.
class EndoscopeLens : private Ogre::Viewport::Listener,
                      private Ogre::CompositorInstance::Listener,
                      private Ogre::SceneManager::Listener,
                      private Ogre::RenderTargetListener {
 public:
  /// Makes the parameters that shaders share; before a material that refers to them is loaded.
  static void provide();

  /// Without effect until set(). @param viewport  may be deleted before this object
  explicit EndoscopeLens(Ogre::Viewport& viewport);
  ~EndoscopeLens() override;
  EndoscopeLens(const EndoscopeLens&) = delete;
  EndoscopeLens& operator=(const EndoscopeLens&) = delete;

  /// Call before each frame; cheap if nothing has changed, including the size of the viewport.
  /// @param field_of_view  across the circle, within kMinFieldOfView and kMaxFieldOfView [rad]
  /// @param sharpness      as in sourceFor()
  /// @throws std::runtime_error  the graphics card does not support it
  void set(LensKind lens, double field_of_view, double sharpness);

  /// What the radiances of the next picture are multiplied with (AutoExposure::gain()).
  void setGain(double gain) { gain_ = gain; }
  /// Mean level of the last picture, weighted to its centre, 0 to 1; nothing before the first. It is read from the
  /// graphics card, which takes a moment.
  std::optional<double> level() const;

  /// The camera whose image the viewport shows, in pixels of the viewport, as of the last set().
  const RoundCamera& camera() const { return camera_; }

 private:
  void viewportDestroyed(Ogre::Viewport* viewport) override;
  void notifyMaterialRender(Ogre::uint32 pass, Ogre::MaterialPtr& material) override;
  void preFindVisibleObjects(Ogre::SceneManager* scene, Ogre::SceneManager::IlluminationRenderStage stage,
                             Ogre::Viewport* viewport) override;
  // The camera takes two pictures with two angles: around that of the middle it has another one.
  void preRenderTargetUpdate(const Ogre::RenderTargetEvent&) override { setAngle(sources_.middle); }
  void postRenderTargetUpdate(const Ogre::RenderTargetEvent&) override { setAngle(sources_.whole); }
  void setAngle(const SquareSource& source);
  void remove();
  void light();
  void make();
  void addTargets(Ogre::CompositionTechnique& technique);
  void setMaterial(const Ogre::MaterialPtr& material, int width, int height);

  Ogre::Viewport* viewport_;  ///< null once it is gone
  RoundCamera camera_;
  double sharpness_ = 0;
  LensSources sources_;
  std::string name_;                             ///< of the compositor; empty: there is none
  Ogre::MaterialPtr material_, meter_material_;  ///< of the picture, and of a small one that measures its level
  Ogre::TexturePtr middle_;                      ///< tells this object when it is drawn; null: there is none
  double gain_ = AutoExposure::kFixedGain;
  Ogre::SceneNode* lamp_ = nullptr;
  DeviceShadow shadow_;
};

}  // namespace vibe::graphics
