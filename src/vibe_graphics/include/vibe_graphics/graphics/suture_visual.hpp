#pragma once
#include <OgreVector3.h>

#include <memory>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"

namespace Ogre {
class SceneNode;
}
namespace rviz {
class MovableText;
}

namespace vibe::graphics {

/// A text that faces the camera.
struct SutureLabel {
  std::string text;     ///< one line
  Ogre::Vector3 place;  ///< in the frame of the node [m]
};

/// Sutures in a scene of Ogre: solid bodies, self-luminous symbols, blood, and labels. To be used from
/// the thread that renders.
class SutureVisual {
 public:
  /// @param parent  parent node; must outlive this object
  /// @throws std::runtime_error  the package's media folder cannot be found
  explicit SutureVisual(Ogre::SceneNode& parent);
  ~SutureVisual();
  SutureVisual(const SutureVisual&) = delete;
  SutureVisual& operator=(const SutureVisual&) = delete;

  /// Thread, bites, T-tags and cinches; in place of the former ones.
  void showSolids(const ColouredShape& shape) { solids_->show(shape); }
  /// Self-luminous symbols, such as links; in place of the former ones.
  void showSigns(const ColouredShape& shape) { signs_->show(shape); }
  void showBlood(const ColouredShape& shape) { blood_->show(shape); }  ///< in place of the former blood
  /// @param height  of the letters [m]
  void showLabels(const std::vector<SutureLabel>& labels, double height);
  void clear();

 private:
  struct Text {
    Ogre::SceneNode* node;
    std::unique_ptr<rviz::MovableText> text;
  };
  void addText(const std::string& text);
  void removeText();

  Ogre::SceneNode& parent_;
  Ogre::MaterialPtr solid_material_, sign_material_, blood_material_;
  std::unique_ptr<ShapeView> solids_, signs_, blood_;
  std::vector<Text> texts_;
};

}  // namespace vibe::graphics
