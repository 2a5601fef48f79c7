#include "vibe_graphics/graphics/endoscope_lamp.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <OgreCamera.h>
#include <OgreEntity.h>
#include <OgreGpuProgramManager.h>
#include <OgreMesh.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreSubEntity.h>
#include <OgreSubMesh.h>

#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {

namespace {

const char* const kLampParameters = "vibe_lamp";  // as in media/*.program
constexpr std::array<const char*, 2> kGuides{"right_guide", "left_guide"};

Ogre::GpuSharedParametersPtr shared() {
  return Ogre::GpuProgramManager::getSingleton().getSharedParameters(kLampParameters);
}

const float* valuesOf(const char* name) {
  const Ogre::GpuSharedParametersPtr parameters = shared();
  const std::size_t place = parameters->getConstantDefinition(name).physicalIndex;
  return std::as_const(*parameters).getFloatPointer(place);
}

}  // namespace

void provideLamp() {
  const auto parameters = Ogre::GpuProgramManager::getSingleton().createSharedParameters(kLampParameters);
  for (const char* guide : kGuides) parameters->addConstantDefinition(guide, Ogre::GCT_FLOAT4);
  parameters->addConstantDefinition("lamp_ahead", Ogre::GCT_FLOAT2);
  parameters->addConstantDefinition("lamp_colour", Ogre::GCT_FLOAT3);
  setLamp({});
}

void setLamp(const EndoscopeLight& light) {
  const auto parameters = shared();
  std::array<float, 2> ahead{};
  for (std::size_t k = 0; k < 2; ++k) {
    const LightGuide& guide = light.guides[k];
    const Eigen::Vector2d cone = coneOf(light, guide);
    const Eigen::Vector4f packed = Eigen::Vector4d(guide.right, guide.up, 0, cone.x()).cast<float>();
    parameters->setNamedConstant(kGuides[k], packed.data(), 4);
    ahead[k] = static_cast<float>(cone.y());
  }
  const Eigen::Vector3f colour = lightColour(light.temperature).cast<float>();
  parameters->setNamedConstant("lamp_ahead", ahead.data(), ahead.size());
  parameters->setNamedConstant("lamp_colour", colour.data(), 3);
}

bool isUsualLamp() {
  const EndoscopeLight usual;
  const float ahead = static_cast<float>(coneOf(usual, usual.guides[0]).y());
  for (std::size_t k = 0; k < 2; ++k) {
    const LightGuide& guide = usual.guides[k];
    const Eigen::Vector4f packed = Eigen::Vector4d(guide.right, guide.up, 0, coneOf(usual, guide).x()).cast<float>();
    if (!std::equal(packed.data(), packed.data() + 4, valuesOf(kGuides[k])) || valuesOf("lamp_ahead")[k] != ahead)
      return false;
  }
  const float* colour = valuesOf("lamp_colour");
  return std::all_of(colour, colour + 3, [](float value) { return value == 1; });
}

std::array<Ogre::Vector3, 2> guidePlaces() {
  return {Ogre::Vector3(valuesOf(kGuides[0])), Ogre::Vector3(valuesOf(kGuides[1]))};
}

namespace {

const char* const kShadowParameters = "vibe_device_shadow";  // as in media/vibe.program
constexpr std::size_t kMaxCapsules = 12;                     // as in media/shadow.glsl
// Parts nearer than this to the lens hold the lens and the guides themselves, or stand behind them [m].
constexpr float kBehind = 0.0005F;

struct ViewCapsule {
  Ogre::Vector3 from, to;
  float radius;
};

void appendCorners(const Ogre::VertexData& data, std::vector<Eigen::Vector3f>& points) {
  const Ogre::VertexElement* element = data.vertexDeclaration->findElementBySemantic(Ogre::VES_POSITION);
  const Ogre::HardwareVertexBufferSharedPtr buffer = data.vertexBufferBinding->getBuffer(element->getSource());
  const Ogre::HardwareBufferLockGuard lock(buffer, Ogre::HardwareBuffer::HBL_READ_ONLY);
  const auto* bytes = static_cast<unsigned char*>(lock.pData) + data.vertexStart * buffer->getVertexSize();
  for (std::size_t k = 0; k < data.vertexCount; ++k, bytes += buffer->getVertexSize())
    points.push_back(Eigen::Map<const Eigen::Vector3f>(reinterpret_cast<const float*>(bytes + element->getOffset())));
}

void appendTriangles(const Ogre::IndexData& data, std::uint32_t first, std::vector<std::uint32_t>& triangles) {
  const Ogre::HardwareBufferLockGuard lock(data.indexBuffer, Ogre::HardwareBuffer::HBL_READ_ONLY);
  const bool wide = data.indexBuffer->getType() == Ogre::HardwareIndexBuffer::IT_32BIT;
  for (std::size_t k = data.indexStart; k < data.indexStart + data.indexCount; ++k)
    triangles.push_back(first + (wide ? static_cast<const std::uint32_t*>(lock.pData)[k]
                                      : static_cast<const std::uint16_t*>(lock.pData)[k]));
}

bool isShown(const Ogre::Entity& entity, std::uint32_t visibility) {
  return entity.isInScene() && entity.isVisible() && (entity.getVisibilityFlags() & visibility) != 0 &&
         entity.getNumSubEntities() > 0 && isMeshOfRobot(*entity.getSubEntity(0)->getMaterial());
}

float distanceTo(const ViewCapsule& capsule, const Ogre::Vector3& place) {
  const Ogre::Vector3 along = capsule.to - capsule.from;
  const float square = std::max(along.squaredLength(), 1e-12F);
  const float t = std::clamp(along.dotProduct(place - capsule.from) / square, 0.0F, 1.0F);
  return (place - capsule.from - t * along).length();
}

/// Whether it can stand between the guides and what they light.
bool casts(const ViewCapsule& capsule) {
  if (std::min(capsule.from.z, capsule.to.z) > -kBehind) return false;
  for (const Ogre::Vector3& guide : guidePlaces())
    if (distanceTo(capsule, guide) < capsule.radius + kBehind) return false;
  return true;
}

Ogre::Vector3 ogreOf(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// The widest of them, as seen from the lens.
void keepWidest(std::vector<ViewCapsule>& capsules) {
  const auto width = [](const ViewCapsule& c) {
    return c.radius * (c.radius + (c.to - c.from).length()) / c.from.midPoint(c.to).squaredLength();
  };
  std::stable_sort(capsules.begin(), capsules.end(),
                   [&](const ViewCapsule& a, const ViewCapsule& b) { return width(a) > width(b); });
  if (capsules.size() > kMaxCapsules) capsules.resize(kMaxCapsules);
}

void send(const std::vector<ViewCapsule>& capsules) {
  std::array<float, 8 * kMaxCapsules> values{};
  float* value = values.data();
  for (const ViewCapsule& c : capsules)
    for (const float number : {c.from.x, c.from.y, c.from.z, c.radius, c.to.x, c.to.y, c.to.z, 0.0F}) *value++ = number;
  const auto shared = Ogre::GpuProgramManager::getSingleton().getSharedParameters(kShadowParameters);
  shared->setNamedConstant("capsules", values.data(), values.size());
  shared->setNamedConstant("capsule_count", static_cast<float>(capsules.size()));
}

}  // namespace

void DeviceShadow::provide() {
  const auto shared = Ogre::GpuProgramManager::getSingleton().createSharedParameters(kShadowParameters);
  shared->addConstantDefinition("capsules", Ogre::GCT_FLOAT4, 2 * kMaxCapsules);
  shared->addConstantDefinition("capsule_count", Ogre::GCT_FLOAT1);
  send({});
}

const std::vector<Capsule>& DeviceShadow::capsulesOf(const Ogre::Mesh& mesh) {
  const auto [entry, is_new] = known_.try_emplace(mesh.getHandle());
  if (!is_new) return entry->second;
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> triangles;
  for (const Ogre::SubMesh* part : mesh.getSubMeshes()) {
    const Ogre::VertexData* corners = part->useSharedVertices ? mesh.sharedVertexData : part->vertexData;
    const auto first = static_cast<std::uint32_t>(points.size());
    appendCorners(*corners, points);
    appendTriangles(*part->indexData, first, triangles);
  }
  return entry->second = fitCapsules(points, triangles);
}

void DeviceShadow::cast(Ogre::SceneManager& scene, const Ogre::Camera& camera, std::uint32_t visibility) {
  std::vector<ViewCapsule> capsules;
  for (const auto& [name, object] : scene.getMovableObjects("Entity")) {
    const auto& entity = static_cast<const Ogre::Entity&>(*object);
    if (!isShown(entity, visibility)) continue;
    const Ogre::Affine3 toView = camera.getViewMatrix(true) * entity.getParentSceneNode()->_getFullTransform();
    const float scale = entity.getParentSceneNode()->_getDerivedScale().x;
    for (const Capsule& c : capsulesOf(*entity.getMesh())) {
      const ViewCapsule seen{toView * ogreOf(c.from), toView * ogreOf(c.to), scale * static_cast<float>(c.radius)};
      if (casts(seen)) capsules.push_back(seen);
    }
  }
  keepWidest(capsules);
  send(capsules);
}

}  // namespace vibe::graphics
