#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::endoscope {

/// The nearest triangle along a ray. Its point is (1 - u - v) a + u b + v c with the corners a, b, c of the triangle.
struct SurfaceHit {
  static constexpr std::uint32_t kNothing = 0xffffffffU;
  std::uint32_t body = kNothing;  ///< as RayScene numbers them
  std::uint32_t triangle = 0;     ///< of the body
  float u = 0, v = 0;             ///< 0 to 1
  bool any() const { return body != kNothing; }
};

/// A half-line from the lens, cut to what a camera draws.
struct CameraRay {
  Eigen::Vector3f direction;  ///< unit, in the frame of the camera
  float begin, end;           ///< distance from the origin; rigid bodies are not met before `begin` [m]
};

/// Triangles that rays are cast at, with Embree (Wald et al. 2014, doi:10.1145/2601097.2601199). Bodies are numbered
/// from 0. Triangles are hit from either side. One thread; the same calls give the same hits.
///
/// Vertices, triangles and colours are not copied: they must stay where they are until the body is set again or the
/// scene is gone.
class RayScene {
 public:
  /// @throws std::runtime_error  Embree cannot be used on this processor
  RayScene();
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Adds a body without triangles, whose vertices move by themselves.
  std::uint32_t addMoving();
  /// Adds a rigid body. It is not met before it is placed.
  std::uint32_t addRigid(const std::vector<graphics::MovingVertex>& vertices,
                         const std::vector<std::uint32_t>& triangles);

  /// Sets vertices [m] and triangles of a moving body; empty: nothing of it is met.
  /// @param colours  rays pass where the interpolated alpha is below one half; null: opaque
  void set(std::uint32_t body, const std::vector<graphics::MovingVertex>& vertices,
           const std::vector<std::uint32_t>& triangles, const std::vector<graphics::PackedColour>* colours = nullptr);
  /// Vertices of a moving body have other places, the triangles are the same.
  void moved(std::uint32_t body);
  /// Places a rigid body; without a pose it is not met.
  void place(std::uint32_t body, const std::optional<Eigen::Isometry3d>& pose);
  /// To be called after changes and before rays are cast.
  void commit();

  /// What each ray meets first. Neighbours in the list should be neighbours in space: they are cast together.
  /// @param camera  pose of the frame of the rays
  void firstHits(const Eigen::Isometry3d& camera, const std::vector<CameraRay>& rays,
                 std::vector<SurfaceHit>& hits) const;
  /// Whether each ray meets something: 1 or 0.
  void areBlocked(const Eigen::Isometry3d& camera, const std::vector<CameraRay>& rays,
                  std::vector<std::uint8_t>& blocked) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace vibe::endoscope
