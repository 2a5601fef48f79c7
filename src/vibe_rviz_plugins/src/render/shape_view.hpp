#pragma once
#include "render/dynamic_mesh.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

/// A shape on the graphics card. Everything is sent if the triangles change, otherwise only the vertices or colours
/// that differ.
class ShapeView {
 public:
  /// @param parent  parent node; must outlive this object
  ShapeView(Ogre::SceneNode& parent, Ogre::MaterialPtr material);

  void show(const ColouredShape& shape);
  void clear();

 private:
  void setBounds();

  DynamicMesh mesh_;
  ColouredShape shown_;
};

}  // namespace vibe::rviz_plugins
