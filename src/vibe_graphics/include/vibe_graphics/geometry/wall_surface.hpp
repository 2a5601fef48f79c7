#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/mesh_index.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics {

/// A point on a wall.
struct WallPlace {
  std::uint32_t triangle = 0;                         ///< in which it lies
  Eigen::Vector3d weight = Eigen::Vector3d::UnitX();  ///< barycentric
  Eigen::Vector3d place = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Vector3d inward = Eigen::Vector3d::UnitZ();  ///< unit, into the lumen, smooth over the wall
};

/// The drawn inside of an organ as a surface on which things lie and run. Triangles without area do no harm.
class WallSurface {
 public:
  /// @param triangles  three vertices each, counter-clockwise seen from outside
  WallSurface(const std::vector<std::uint32_t>& triangles, std::size_t vertex_count);

  /// Where the wall is now.
  /// @param vertices  as DeformableSurface has them, normals outward
  /// @param pose      of their frame in that of the results
  /// @return  whether anything has moved
  bool move(const std::vector<MovingVertex>& vertices, const Eigen::Isometry3d& pose);

  /// The point nearest to a place among the triangles around the nearest vertex; none: nothing is near.
  /// @param inward  approximate direction into the lumen; walls that face the other way are passed over. Zero: unknown
  /// @param reach   of the nearest vertex [m]
  std::optional<WallPlace> nearest(const Eigen::Vector3d& place, const Eigen::Vector3d& inward, double reach) const;

  /// The point that is reached by going a short way (less than a triangle is best) and back to the wall.
  WallPlace moved(const WallPlace& from, const Eigen::Vector3d& way) const;

  /// Where a line meets the wall from the lumen for the first time; none: nowhere.
  /// @param along  set to the place on the line: the number of the point before and the part of the way to the next
  std::optional<WallPlace> landing(const std::vector<Eigen::Vector3d>& line, double& along) const;

  /// The place of a vertex, which has to be a corner of some triangle.
  WallPlace atVertex(std::uint32_t vertex) const;

  const std::vector<Eigen::Vector3d>& places() const { return places_; }    ///< of vertices [m]
  const std::vector<Eigen::Vector3d>& inwards() const { return inwards_; }  ///< unit, into the lumen, of vertices
  std::size_t triangleCount() const { return triangles_.size() / 3; }       ///< of those that were given
  /// Three vertices; valid as long as this object.
  const std::uint32_t* corners(std::uint32_t triangle) const { return &triangles_[3 * std::size_t{triangle}]; }
  /// Triangles around a vertex.
  const Incidence& around() const { return around_; }

 private:
  WallPlace at(std::uint32_t triangle, const Eigen::Vector3d& weight) const;
  std::vector<std::uint32_t> trianglesNear(const std::vector<Eigen::Vector3d>& line) const;
  WallPlace nearestAround(std::uint32_t triangle, const Eigen::Vector3d& place) const;
  void tryTriangle(std::uint32_t triangle, const Eigen::Vector3d& place, double& distance, std::uint32_t& best,
                   Eigen::Vector3d& weight) const;

  std::vector<std::uint32_t> triangles_;
  Incidence around_;
  std::vector<MovingVertex> vertices_;  // as they were given
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> places_, inwards_;
};

}  // namespace vibe::graphics
