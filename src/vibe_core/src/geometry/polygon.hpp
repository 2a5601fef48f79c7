#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Cuts a polygon, convex or not, into triangles of its corners that face the same side. No corner is left out, even on
/// a straight edge, since a neighbour may end there; and no triangle lacks area if that can be avoided. Ears are cut
/// off (Meisters 1975, Am Math Mon 82:648) in the order of their quality. A polygon without area becomes a fan.
/// @param corners  vertex numbers within `points`, at most kMaxCorners
/// @returns false, and no triangles, if two sides of the outline cross
bool cutPolygon(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& corners,
                std::vector<std::array<int, 3>>& triangles);

constexpr std::size_t kMaxCorners = 20000;  ///< the effort grows with the square

/// The faces of a file before its vertices are all known.
struct FaceList {
  std::vector<std::int64_t> corners;  ///< vertex numbers from 0, not checked
  std::vector<std::size_t> ends;      ///< of each face in `corners`
  std::vector<int> places;            ///< line or number of each face
};

/// Adds the faces to a mesh that has all its vertices.
/// @param first  number of a vertex in the format that is 0 here: 1 for OBJ
/// @param name   "line" or "face", which stands before the place in errors
/// @throws Error, as a clause, for a vertex that is not there and an outline that crosses itself
void addFaces(const FaceList& faces, int first, const std::string& name, SurfaceMesh& mesh);

}  // namespace vibe
