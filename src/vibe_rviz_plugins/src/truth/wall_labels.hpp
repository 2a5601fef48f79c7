#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/tissue_mesh.hpp"

namespace vibe::rviz_plugins {

/// Region, wall and heat of every point of the drawn surface of the organ.
///
/// A vertex has the region and the wall that have the largest share of the particles that carry it, and the mean of
/// their grades of heat. Within a triangle, region and wall are those of the nearest corner (the largest barycentric
/// coordinate), and the grade is interpolated and rounded: the colour is drawn from the same interpolated value.
class WallLabels {
 public:
  void setMesh(const TissueMesh& mesh);
  void setFrame(const TissueMesh& mesh, const TissueFrame& frame);
  /// @param corner  vertices of the triangle
  /// @param weight  barycentric coordinates of the point
  std::uint8_t at(const std::uint32_t* corner, const std::array<float, 3>& weight) const;

 private:
  std::vector<std::uint8_t> cold_;   // per vertex: its label without heat
  std::vector<std::uint8_t> grade_;  // per particle, of the last frame
  std::vector<float> heat_;          // per vertex; empty: no heat anywhere
};

}  // namespace vibe::rviz_plugins
