#include "truth/ray_scene.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace vibe::endoscope {

/// What the filter of a translucent body reads.
struct Veil {
  const std::vector<std::uint32_t>* triangles = nullptr;
  const std::vector<graphics::PackedColour>* colours = nullptr;
};

namespace {

constexpr std::size_t kPacket = 8;  // rays that are cast together
constexpr float kOpaque = 127.5F;   // alpha from which a translucent surface is met, of 255

/// Casts packets of coherent rays, with Embree 3 or 4.
#if RTC_VERSION_MAJOR >= 4
class PacketQuery {
 public:
  PacketQuery() { rtcInitRayQueryContext(&context_); }

  void intersect(const int* valid, RTCScene scene, RTCRayHit8& packet) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context_, arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &packet, &arguments);
  }
  void occlude(const int* valid, RTCScene scene, RTCRay8& packet) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context_, arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &packet, &arguments);
  }

 private:
  RTCRayQueryContext context_;
};
#else
class PacketQuery {
 public:
  PacketQuery() {
    rtcInitIntersectContext(&context_);
    context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }

  void intersect(const int* valid, RTCScene scene, RTCRayHit8& packet) {
    rtcIntersect8(valid, scene, &context_, &packet);
  }
  void occlude(const int* valid, RTCScene scene, RTCRay8& packet) { rtcOccluded8(valid, scene, &context_, &packet); }

 private:
  RTCIntersectContext context_;
};
#endif

float alphaAt(const Veil& veil, std::uint32_t triangle, float u, float v) {
  const float weight[3] = {1 - u - v, u, v};
  float alpha = 0;
  for (std::size_t k = 0; k < 3; ++k)
    alpha += weight[k] * static_cast<float>((*veil.colours)[(*veil.triangles)[3 * triangle + k]] >> 24);
  return alpha;
}

/// Lets rays pass where a body is hardly visible.
void passVeil(const RTCFilterFunctionNArguments* arguments) {
  const Veil& veil = *static_cast<const Veil*>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const float u = RTCHitN_u(arguments->hit, arguments->N, i), v = RTCHitN_v(arguments->hit, arguments->N, i);
    if (alphaAt(veil, RTCHitN_primID(arguments->hit, arguments->N, i), u, v) < kOpaque) arguments->valid[i] = 0;
  }
}

/// Lets rays pass a rigid body before they begin, as the near plane cuts it. What moves is met from the origin on.
void passNear(const RTCFilterFunctionNArguments* arguments) {
  for (unsigned i = 0; i < arguments->N; ++i)
    if (RTCRayN_tfar(arguments->ray, arguments->N, i) < RTCRayN_time(arguments->ray, arguments->N, i))
      arguments->valid[i] = 0;
}

void setTriangles(RTCGeometry geometry, const std::vector<graphics::MovingVertex>& vertices,
                  const std::vector<std::uint32_t>& triangles) {
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                             sizeof(graphics::MovingVertex), vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                             3 * sizeof(std::uint32_t), triangles.size() / 3);
}

/// Up to kPacket rays; the rest of the packet is switched off.
void fill(const Eigen::Isometry3f& camera, const CameraRay* rays, std::size_t count, RTCRay8& packet, int* valid) {
  const Eigen::Matrix3f turn = camera.linear();
  const Eigen::Vector3f origin = camera.translation();
  for (std::size_t i = 0; i < kPacket; ++i) {
    const CameraRay& ray = rays[std::min(i, count - 1)];
    const Eigen::Vector3f direction = turn * ray.direction;
    valid[i] = i < count ? -1 : 0;
    packet.org_x[i] = origin.x(), packet.org_y[i] = origin.y(), packet.org_z[i] = origin.z();
    packet.dir_x[i] = direction.x(), packet.dir_y[i] = direction.y(), packet.dir_z[i] = direction.z();
    packet.tnear[i] = 0, packet.tfar[i] = ray.end;
    packet.time[i] = ray.begin;  // nothing here moves during a picture, so that the time is free for passNear()
    packet.mask[i] = 0xffffffffU, packet.id[i] = 0, packet.flags[i] = 0;
  }
}

RTCRay8& raysOf(RTCRay8& packet) {
  return packet;
}
RTCRay8& raysOf(RTCRayHit8& packet) {
  return packet.ray;
}

/// Calls `cast(first, count, valid, query, packet)` for all rays, packet by packet.
template <class Packet, class Cast>
void forPackets(const Eigen::Isometry3d& camera, const std::vector<CameraRay>& rays, Cast cast) {
  const Eigen::Isometry3f single = camera.cast<float>();
  PacketQuery query;
  alignas(64) Packet packet;
  alignas(64) int valid[kPacket];
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - first);
    fill(single, &rays[first], count, raysOf(packet), valid);
    cast(first, count, valid, query, packet);
  }
}

SurfaceHit hitOf(const RTCHit8& hit, std::size_t i) {
  SurfaceHit result;
  if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) return result;
  result.body = hit.instID[0][i] == RTC_INVALID_GEOMETRY_ID ? hit.geomID[i] : hit.instID[0][i];
  result.triangle = hit.primID[i];
  result.u = hit.u[i], result.v = hit.v[i];
  return result;
}

}  // namespace

struct RayScene::Embree {
  struct Body {
    RTCGeometry geometry = nullptr;  // the instance of a rigid body
    RTCScene rigid = nullptr;        // the triangles of a rigid body
    Veil veil;
  };

  Embree() : device(rtcNewDevice("threads=1,set_affinity=0")) {
    if (device == nullptr)
      throw std::runtime_error("Embree cannot be started (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                               "; 4: too little memory, 5: a processor without SSE2).");
    scene = rtcNewScene(device);
    // the shapes move in every frame, and a ray must not slip through between two triangles
    rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  }
  ~Embree() {
    for (const auto& body : bodies) {
      rtcReleaseGeometry(body->geometry);
      if (body->rigid != nullptr) rtcReleaseScene(body->rigid);
    }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  std::uint32_t attach(std::unique_ptr<Body> body) {
    rtcDisableGeometry(body->geometry);
    rtcCommitGeometry(body->geometry);
    const std::uint32_t number = rtcAttachGeometry(scene, body->geometry);
    bodies.push_back(std::move(body));
    return number;
  }

  RTCDevice device;
  RTCScene scene;
  std::vector<std::unique_ptr<Body>> bodies;  // each stays where it is, because its filter refers to it
};

RayScene::RayScene() : embree_(std::make_unique<Embree>()) {}

RayScene::~RayScene() = default;

std::uint32_t RayScene::addMoving() {
  auto body = std::make_unique<Embree::Body>();
  body->geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryUserData(body->geometry, &body->veil);
  return embree_->attach(std::move(body));
}

std::uint32_t RayScene::addRigid(const std::vector<graphics::MovingVertex>& vertices,
                                 const std::vector<std::uint32_t>& triangles) {
  auto body = std::make_unique<Embree::Body>();
  body->rigid = rtcNewScene(embree_->device);
  rtcSetSceneFlags(body->rigid, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry shape = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  setTriangles(shape, vertices, triangles);
  rtcSetGeometryIntersectFilterFunction(shape, passNear);
  rtcSetGeometryOccludedFilterFunction(shape, passNear);
  rtcCommitGeometry(shape);
  rtcAttachGeometry(body->rigid, shape);
  rtcReleaseGeometry(shape);
  rtcCommitScene(body->rigid);
  body->geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(body->geometry, body->rigid);
  return embree_->attach(std::move(body));
}

void RayScene::set(std::uint32_t number, const std::vector<graphics::MovingVertex>& vertices,
                   const std::vector<std::uint32_t>& triangles, const std::vector<graphics::PackedColour>* colours) {
  Embree::Body& body = *embree_->bodies.at(number);
  if (triangles.empty()) return rtcDisableGeometry(body.geometry);
  body.veil = {&triangles, colours};
  setTriangles(body.geometry, vertices, triangles);
  rtcSetGeometryBuildQuality(body.geometry, RTC_BUILD_QUALITY_LOW);
  rtcSetGeometryIntersectFilterFunction(body.geometry, colours ? passVeil : nullptr);
  rtcSetGeometryOccludedFilterFunction(body.geometry, colours ? passVeil : nullptr);
  rtcEnableGeometry(body.geometry);
  rtcCommitGeometry(body.geometry);
}

void RayScene::moved(std::uint32_t number) {
  Embree::Body& body = *embree_->bodies.at(number);
  // the tree keeps its order while the vertices move, which takes half as long as a new one
  rtcSetGeometryBuildQuality(body.geometry, RTC_BUILD_QUALITY_REFIT);
  rtcUpdateGeometryBuffer(body.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(body.geometry);
}

void RayScene::place(std::uint32_t number, const std::optional<Eigen::Isometry3d>& pose) {
  Embree::Body& body = *embree_->bodies.at(number);
  if (!pose) return rtcDisableGeometry(body.geometry);
  const Eigen::Matrix<float, 3, 4> matrix = pose->matrix().topRows<3>().cast<float>();
  rtcSetGeometryTransform(body.geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
  rtcEnableGeometry(body.geometry);
  rtcCommitGeometry(body.geometry);
}

void RayScene::commit() {
  rtcCommitScene(embree_->scene);
}

void RayScene::firstHits(const Eigen::Isometry3d& camera, const std::vector<CameraRay>& rays,
                         std::vector<SurfaceHit>& hits) const {
  hits.resize(rays.size());
  forPackets<RTCRayHit8>(
      camera, rays,
      [&](std::size_t first, std::size_t count, const int* valid, PacketQuery& query, RTCRayHit8& packet) {
        std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
        query.intersect(valid, embree_->scene, packet);
        for (std::size_t i = 0; i < count; ++i) hits[first + i] = hitOf(packet.hit, i);
      });
}

void RayScene::areBlocked(const Eigen::Isometry3d& camera, const std::vector<CameraRay>& rays,
                          std::vector<std::uint8_t>& blocked) const {
  blocked.resize(rays.size());
  forPackets<RTCRay8>(camera, rays,
                      [&](std::size_t first, std::size_t count, const int* valid, PacketQuery& query, RTCRay8& packet) {
                        query.occlude(valid, embree_->scene, packet);
                        // Embree sets the end of a ray that meets something to minus infinity
                        for (std::size_t i = 0; i < count; ++i) blocked[first + i] = packet.tfar[i] < 0;
                      });
}

}  // namespace vibe::endoscope
