#pragma once
#include <OgreMaterial.h>
#include <OgreViewport.h>

#include <string>

#include "geometry/lens.hpp"

namespace Ogre {
class SceneNode;
}  // namespace Ogre

namespace vibe {

/// Makes a viewport show what an endoscope shows: bent by its lens, black outside of a circle, lit by its lamp: scheme
/// kEndoscopeScheme for materials of this package, a light in the scene for those of others. The viewport's camera has
/// to be where the lens is; its angles are set here. Ends when deleted or when the viewport is: rviz takes its window
/// down before its views. The scene has to outlive it.
class EndoscopeLens : private Ogre::Viewport::Listener {
 public:
  explicit EndoscopeLens(Ogre::Viewport& viewport);
  ~EndoscopeLens() override;
  EndoscopeLens(const EndoscopeLens&) = delete;
  EndoscopeLens& operator=(const EndoscopeLens&) = delete;

  /// To be called before each picture; cheap where nothing has changed, the size of the viewport included.
  /// @param field_of_view  across the circle, within kMinFieldOfView and kMaxFieldOfView [rad]
  /// @param sharpness      as in sourceFor()
  /// @throws std::runtime_error  the graphics card cannot do it
  void set(LensKind lens, double field_of_view, double sharpness);

  /// The camera whose picture the viewport shows, in pixels of the viewport, as of the last set().
  const RoundCamera& camera() const { return camera_; }

 private:
  void viewportDestroyed(Ogre::Viewport* viewport) override;
  void remove();
  void light();
  void make(const SquareSource& source);
  void setMaterial(const SquareSource& source);

  Ogre::Viewport* viewport_;  ///< null once it is gone
  RoundCamera camera_;
  double sharpness_ = 0;
  SquareSource source_;
  std::string name_;  ///< of the compositor; empty: there is none
  Ogre::MaterialPtr material_;
  Ogre::SceneNode* lamp_ = nullptr;
};

}  // namespace vibe
