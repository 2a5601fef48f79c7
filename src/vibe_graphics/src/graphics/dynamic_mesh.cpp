#include "vibe_graphics/graphics/dynamic_mesh.hpp"

#include <OgreEntity.h>
#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgreMeshManager.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreSubEntity.h>
#include <OgreSubMesh.h>

#include <cstddef>

#include "vibe_graphics/geometry/mesh_index.hpp"
#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {
namespace {

enum Source : unsigned short { Vertices, Colours, Fixed, Mucosa, Heights, Browned };

template <class T>
Ogre::HardwareVertexBufferSharedPtr vertexBuffer(std::size_t count, std::size_t size, const T* values, bool changes) {
  const auto usage =
      changes ? Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY : Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY;
  auto buffer = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(size, count, usage);
  buffer->writeData(0, size * count, values, true);
  return buffer;
}

void write(Ogre::HardwareVertexBuffer& buffer, const void* values, std::size_t first, std::size_t count) {
  const std::size_t size = buffer.getVertexSize();
  buffer.writeData(first * size, count * size, values, first == 0 && count == buffer.getNumVertices());
}

}  // namespace

DynamicMesh::DynamicMesh(Ogre::SceneNode& parent, std::vector<Ogre::MaterialPtr> materials)
    : parent_(parent), materials_(std::move(materials)) {}

DynamicMesh::~DynamicMesh() {
  clear();
}

void DynamicMesh::clear() {
  if (entity_ != nullptr) {
    parent_.detachObject(entity_);
    parent_.getCreator()->destroyEntity(entity_);
    entity_ = nullptr;
  }
  if (mesh_) Ogre::MeshManager::getSingleton().remove(mesh_);
  mesh_.reset();
  vertices_.reset(), colours_.reset(), heights_.reset(), browned_.reset();
  vertex_count_ = triangle_count_ = 0;
}

void DynamicMesh::setTopology(const std::vector<std::uint32_t>& triangles, std::size_t vertex_count,
                              const std::vector<float>& fixed, const std::vector<MucosaVertex>& mucosa) {
  clear();
  if (triangles.empty() || vertex_count == 0) return;
  vertex_count_ = vertex_count;
  triangle_count_ = triangles.size() / 3;
  mesh_ = Ogre::MeshManager::getSingleton().createManual(uniqueName("Mesh"), kResourceGroup);
  makeVertexData(fixed);
  if (mucosa.size() == vertex_count) addMucosa(mucosa);
  makeIndexData(sortedInSpace(triangles, fixed));
  mesh_->_setBounds(Ogre::AxisAlignedBox::BOX_NULL);
  mesh_->load();
  entity_ = parent_.getCreator()->createEntity(mesh_);
  entity_->setCastShadows(false);
  entity_->setListener(this);
  entity_->setVisible(visible_);
  parent_.attachObject(entity_);
  setMaterials(materials_);
}

void DynamicMesh::makeVertexData(const std::vector<float>& fixed) {
  auto* data = new Ogre::VertexData;  // the mesh deletes it
  mesh_->sharedVertexData = data;
  data->vertexCount = vertex_count_;
  Ogre::VertexDeclaration& layout = *data->vertexDeclaration;
  layout.addElement(Vertices, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout.addElement(Vertices, sizeof(MovingVertex::position), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  layout.addElement(Colours, 0, Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
  layout.addElement(Fixed, 0, Ogre::VET_FLOAT3, Ogre::VES_TEXTURE_COORDINATES, 0);
  const std::vector<MovingVertex> origin(vertex_count_, MovingVertex{{0, 0, 0}, {0, 0, 1}});
  const std::vector<PackedColour> white(vertex_count_, 0xffffffffu);
  std::vector<float> places = fixed;
  places.resize(3 * vertex_count_);
  vertices_ = vertexBuffer(vertex_count_, sizeof(MovingVertex), origin.data(), true);
  colours_ = vertexBuffer(vertex_count_, sizeof(PackedColour), white.data(), true);
  data->vertexBufferBinding->setBinding(Vertices, vertices_);
  data->vertexBufferBinding->setBinding(Colours, colours_);
  data->vertexBufferBinding->setBinding(Fixed, vertexBuffer(vertex_count_, 3 * sizeof(float), places.data(), false));
}

void DynamicMesh::addMucosa(const std::vector<MucosaVertex>& mucosa) {
  Ogre::VertexDeclaration& layout = *mesh_->sharedVertexData->vertexDeclaration;
  layout.addElement(Mucosa, 0, Ogre::VET_FLOAT4, Ogre::VES_TEXTURE_COORDINATES, 1);
  layout.addElement(Mucosa, offsetof(MucosaVertex, folded), Ogre::VET_FLOAT4, Ogre::VES_TEXTURE_COORDINATES, 2);
  layout.addElement(Heights, 0, Ogre::VET_FLOAT1, Ogre::VES_TEXTURE_COORDINATES, 3);
  layout.addElement(Browned, 0, Ogre::VET_FLOAT1, Ogre::VES_TEXTURE_COORDINATES, 4);
  const std::vector<float> none(vertex_count_, 0.0F);
  heights_ = vertexBuffer(vertex_count_, sizeof(float), none.data(), true);
  browned_ = vertexBuffer(vertex_count_, sizeof(float), none.data(), true);
  Ogre::VertexBufferBinding& binding = *mesh_->sharedVertexData->vertexBufferBinding;
  binding.setBinding(Mucosa, vertexBuffer(vertex_count_, sizeof(MucosaVertex), mucosa.data(), false));
  binding.setBinding(Heights, heights_);
  binding.setBinding(Browned, browned_);
}

void DynamicMesh::makeIndexData(const std::vector<std::uint32_t>& triangles) {
  auto buffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, triangles.size(), Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  buffer->writeData(0, triangles.size() * sizeof(std::uint32_t), triangles.data(), true);
  for (std::size_t k = 0; k < materials_.size(); ++k) {
    Ogre::SubMesh* part = mesh_->createSubMesh();
    part->useSharedVertices = true;
    part->indexData->indexBuffer = buffer;
    part->indexData->indexStart = 0;
    part->indexData->indexCount = triangles.size();
  }
}

void DynamicMesh::setVertices(const MovingVertex* vertices, std::size_t first, std::size_t count) {
  if (vertices_ && count > 0) write(*vertices_, vertices, first, count);
}

void DynamicMesh::setColours(const PackedColour* colours, std::size_t first, std::size_t count) {
  if (colours_ && count > 0) write(*colours_, colours, first, count);
}

void DynamicMesh::setHeights(const std::vector<float>& heights) {
  if (heights_ && heights.size() == vertex_count_) write(*heights_, heights.data(), 0, vertex_count_);
}

void DynamicMesh::setBrowned(const std::vector<float>& browned) {
  if (browned_ && browned.size() == vertex_count_) write(*browned_, browned.data(), 0, vertex_count_);
}

// Ogre asks whether it may draw, for each camera that sees the box; by then the scheme of its viewport is set.
bool DynamicMesh::objectRendering(const Ogre::MovableObject*, const Ogre::Camera*) {
  if (before_endoscope_ && Ogre::MaterialManager::getSingleton().getActiveScheme() == kEndoscopeScheme)
    before_endoscope_();
  return true;
}

void DynamicMesh::setBounds(const Ogre::AxisAlignedBox& bounds) {
  if (!mesh_) return;
  mesh_->_setBounds(bounds, false);
  mesh_->_setBoundingSphereRadius(bounds.isFinite() ? bounds.getSize().length() : 0);
  parent_.needUpdate();
}

void DynamicMesh::setMaterials(std::vector<Ogre::MaterialPtr> materials) {
  const bool same_count = materials.size() == materials_.size();
  materials_ = std::move(materials);
  if (entity_ == nullptr || !same_count) return;
  for (std::size_t k = 0; k < materials_.size(); ++k) entity_->getSubEntity(k)->setMaterial(materials_[k]);
}

void DynamicMesh::setVisible(bool visible) {
  visible_ = visible;
  if (entity_ != nullptr) entity_->setVisible(visible);
}

}  // namespace vibe::graphics
