#pragma once

#include <memory>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/graphics/dynamic_mesh.hpp"

namespace Ogre {
class SceneNode;
}

namespace vibe::graphics {

/// A shape on the graphics card. Everything is sent if the triangles change, otherwise only the vertices or colours
/// that differ.
class ShapeView {
 public:
  /// @param parent  parent node; must outlive this object
  ShapeView(Ogre::SceneNode& parent, Ogre::MaterialPtr material);

  void show(const ColouredShape& shape);  ///< in place of the former one; without problem (see problemOf())
  void clear();

 private:
  void setBounds();

  DynamicMesh mesh_;
  ColouredShape shown_;
};

/// A solid shape in a scene of Ogre, with the material of this package that also follows the light of the endoscope.
/// To be used from the thread that renders.
class ShapeVisual {
 public:
  /// @param parent  in whose frame the vertices are; outlives this
  /// @throws std::runtime_error  the media folder of vibe_graphics cannot be found
  explicit ShapeVisual(Ogre::SceneNode& parent);
  ~ShapeVisual();
  ShapeVisual(const ShapeVisual&) = delete;
  ShapeVisual& operator=(const ShapeVisual&) = delete;

  /// Draws this shape in place of the former one; an empty shape draws nothing.
  /// @param shape  without problem (see problemOf())
  void show(const ColouredShape& shape);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vibe::graphics
