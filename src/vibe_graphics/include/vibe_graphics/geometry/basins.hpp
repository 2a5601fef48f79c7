#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vibe_graphics/geometry/wall_surface.hpp"

namespace vibe::graphics {

/// Where something that flows slowly runs on a wall: the line of steepest descent of its smooth normals, in steps of
/// 1.2 mm or less. It ends where the wall goes down no more (a hollow, or the tip of a fold that hangs down), or after
/// 400 steps. The same wall and start give the same line.
/// @param down  direction of gravity, unit
/// @return  from the start on; at least the start
std::vector<WallPlace> steepestDescent(const WallSurface& wall, const WallPlace& start, const Eigen::Vector3d& down);

/// The vertex that is reached from a point by going to the lowest neighbour until there is none: the bottom of a
/// hollow.
std::uint32_t bottomBelow(const WallSurface& wall, const WallPlace& point, const Eigen::Vector3d& down);
/// The same from a vertex.
std::uint32_t bottomBelow(const WallSurface& wall, std::uint32_t vertex, const Eigen::Vector3d& down);

/// A fluid at rest on a wall.
struct Pool {
  std::vector<std::uint32_t> bottoms;    ///< lowest vertices of the hollows it fills, at least one
  double volume = 0;                     ///< [m^3]
  double level = 0;                      ///< height of its surface, against gravity from the origin [m]
  double brown = 0;                      ///< part of it that has clotted, 0 to 1
  std::vector<std::uint32_t> triangles;  ///< all that are below the level in part, and some that are not
};

/// Where a full hollow has run over.
struct Brim {
  std::uint32_t vertex = 0;  ///< the fluid went on from here
  double brown = 0;          ///< of what went over, as in Pool (ratio)
};

/// The hollows of a wall and what stands in them. A hollow that is full to its brim runs over into the next one, and
/// two that are full to the same brim become one. Under a pool the wall is the whole of its lower boundary; the open
/// edge of a surface holds like a vertical wall.
class Basins {
 public:
  /// @param wall  must outlive this object and stay as it is
  /// @param down  direction of gravity, unit
  Basins(const WallSurface& wall, const Eigen::Vector3d& down);

  /// @param vertex  the fluid runs down from there
  void pour(std::uint32_t vertex, double volume, double brown);

  const std::vector<Pool>& pools() const { return pools_; }  ///< all that stands, in no special order
  const std::vector<Brim>& brims() const { return brims_; }  ///< one for each time that a hollow has run over

  /// Height of a vertex against gravity, from the origin [m].
  double height(std::uint32_t vertex) const { return -wall_.places()[vertex].dot(down_); }

 private:
  struct Flood;
  /// What stands on a triangle: its signed horizontal area [m^2] and the heights of its corners [m].
  struct Column {
    double projected, low, middle, high;
  };
  std::optional<std::size_t> poolAt(std::uint32_t bottom) const;
  void absorb(std::size_t pool, Pool& into);
  bool fill(Pool& pool, std::uint32_t& brim, double& rest);
  bool joins(std::uint32_t bottom, double level, Pool& pool);
  void wet(std::uint32_t vertex, Flood& flood, Pool& pool) const;
  Column columnOver(std::uint32_t triangle) const;
  static double levelOf(double volume, const Flood& flood, double low);

  const WallSurface& wall_;
  Eigen::Vector3d down_;
  std::vector<Pool> pools_;
  std::vector<Brim> brims_;
};

/// Volume over a triangle below a level: what stands on its horizontal projection. Negative where it faces down [m^3].
/// @param projected  signed area of the projection [m^2]
/// @param a, b, c    depth of its corners below the level, the deepest first; negative above it [m]
double volumeOnTriangle(double projected, double a, double b, double c);

}  // namespace vibe::graphics
