#pragma once
#include <OgreAxisAlignedBox.h>
#include <OgreHardwareVertexBuffer.h>
#include <OgreMaterial.h>
#include <OgreMesh.h>
#include <OgreMovableObject.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/mucosa_map.hpp"

namespace Ogre {
class Entity;
class SceneNode;
}  // namespace Ogre

namespace vibe::graphics {

/// Triangles with moving vertices in hardware buffers. Only what changes is sent to the graphics card; vertices and
/// colours have separate buffers, so tissue that moves without changing colour sends only its vertices.
/// To be used from the thread that renders.
class DynamicMesh : private Ogre::MovableObject::Listener {
 public:
  /// @param parent     parent node; must outlive this object
  /// @param materials  the triangles are drawn once with each material, from the same vertices; see resources.hpp
  DynamicMesh(Ogre::SceneNode& parent, std::vector<Ogre::MaterialPtr> materials);
  ~DynamicMesh() override;
  DynamicMesh(const DynamicMesh&) = delete;
  DynamicMesh& operator=(const DynamicMesh&) = delete;

  /// Sets new triangles. Vertices (now at the origin) and colours (now white) must be set again. Without triangles,
  /// nothing is drawn.
  /// @param triangles  three vertex numbers each, counter-clockwise seen from outside
  /// @param fixed      x y z per vertex that shaders read as texture coordinate, for example the place at rest, so that
  ///                   a texture moves with the surface; empty: zero
  /// @param mucosa     one per vertex for the shader of the mucosa; empty: none, and no heights can be set
  void setTopology(const std::vector<std::uint32_t>& triangles, std::size_t vertex_count,
                   const std::vector<float>& fixed = {}, const std::vector<MucosaVertex>& mucosa = {});
  /// Sets the vertices from `first` on.
  void setVertices(const MovingVertex* vertices, std::size_t first, std::size_t count);
  /// Sets the colours of the vertices from `first` on.
  void setColours(const PackedColour* colours, std::size_t first, std::size_t count);
  /// Sets the heights of the folds of all vertices [m]; now 0.
  void setHeights(const std::vector<float>& heights);
  /// Sets how brown the scars of all vertices are (ScarAge::browned()), a ratio; now 0.
  void setBrowned(const std::vector<float>& browned);
  /// What to do each time before it is drawn for the endoscope, for values that only its materials read.
  void beforeEndoscope(std::function<void()> prepare) { before_endoscope_ = std::move(prepare); }
  /// Sets the box around all vertices; anything outside may be culled.
  void setBounds(const Ogre::AxisAlignedBox& bounds);

  /// Draws with other materials from now on; if their number is another one, from the next setTopology() on.
  void setMaterials(std::vector<Ogre::MaterialPtr> materials);
  void setVisible(bool visible);  ///< also of what is set later

  std::size_t vertexCount() const { return vertex_count_; }      ///< as of setTopology()
  std::size_t triangleCount() const { return triangle_count_; }  ///< as of setTopology()

 private:
  bool objectRendering(const Ogre::MovableObject* object, const Ogre::Camera* camera) override;
  void clear();
  void makeVertexData(const std::vector<float>& fixed);
  void addMucosa(const std::vector<MucosaVertex>& mucosa);
  void makeIndexData(const std::vector<std::uint32_t>& triangles);

  Ogre::SceneNode& parent_;
  std::vector<Ogre::MaterialPtr> materials_;
  Ogre::MeshPtr mesh_;
  Ogre::Entity* entity_ = nullptr;
  Ogre::HardwareVertexBufferSharedPtr vertices_, colours_, heights_, browned_;
  std::function<void()> before_endoscope_;
  std::size_t vertex_count_ = 0, triangle_count_ = 0;
  bool visible_ = true;
};

}  // namespace vibe::graphics
