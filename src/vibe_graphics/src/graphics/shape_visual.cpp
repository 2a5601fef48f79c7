#include "vibe_graphics/graphics/shape_visual.hpp"

#include <cstring>

#include <OgreSceneNode.h>

#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {

namespace {

bool same(const std::vector<MovingVertex>& a, const std::vector<MovingVertex>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

}  // namespace

ShapeView::ShapeView(Ogre::SceneNode& parent, Ogre::MaterialPtr material)
    : mesh_(parent, std::vector<Ogre::MaterialPtr>{std::move(material)}) {}

void ShapeView::show(const ColouredShape& shape) {
  const bool new_triangles = shape.vertices.size() != shown_.vertices.size() || shape.triangles != shown_.triangles;
  const bool moved = new_triangles || !same(shape.vertices, shown_.vertices);
  const bool recoloured = new_triangles || shape.colours != shown_.colours;
  if (!moved && !recoloured) return;
  shown_ = shape;
  if (new_triangles) mesh_.setTopology(shape.triangles, shape.vertices.size());
  if (mesh_.vertexCount() == 0) return;
  if (moved) mesh_.setVertices(shape.vertices.data(), 0, shape.vertices.size());
  if (recoloured) mesh_.setColours(shape.colours.data(), 0, shape.colours.size());
  if (moved) setBounds();
}

void ShapeView::clear() {
  show({});
}

void ShapeView::setBounds() {
  Ogre::AxisAlignedBox box;
  for (const MovingVertex& vertex : shown_.vertices)
    box.merge(Ogre::Vector3(vertex.position[0], vertex.position[1], vertex.position[2]));
  mesh_.setBounds(box);
}

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

}  // namespace vibe::graphics
