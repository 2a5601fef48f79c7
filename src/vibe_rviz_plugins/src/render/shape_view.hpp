#pragma once
#include "render/dynamic_mesh.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe {

/// A shape on the graphics card that sends only what is new: all of it when its triangles change, else vertices and
/// colours as far as they differ from what is there.
class ShapeView {
 public:
  /// @param parent  node to hang it on; outlives this
  ShapeView(Ogre::SceneNode& parent, Ogre::MaterialPtr material);

  void show(const ColouredShape& shape);
  void clear();

 private:
  void setBounds();

  DynamicMesh mesh_;
  ColouredShape shown_;
};

}  // namespace vibe
