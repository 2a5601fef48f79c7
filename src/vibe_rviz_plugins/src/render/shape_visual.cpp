#include "vibe_rviz_plugins/render/shape_visual.hpp"

#include "render/resources.hpp"
#include "render/shape_view.hpp"

namespace vibe::rviz_plugins {

struct ShapeVisual::Parts {
  explicit Parts(Ogre::SceneNode& parent)
      : material(copyMaterial("vibe/solid")), view(std::make_unique<ShapeView>(parent, material)) {}
  ~Parts() {
    view.reset();
    dropMaterial(material);
  }

  Ogre::MaterialPtr material;
  std::unique_ptr<ShapeView> view;
};

ShapeVisual::ShapeVisual(Ogre::SceneNode& parent) : parts_(std::make_unique<Parts>(parent)) {}

ShapeVisual::~ShapeVisual() = default;

void ShapeVisual::show(const ColouredShape& shape) {
  parts_->view->show(shape);
}

}  // namespace vibe::rviz_plugins
