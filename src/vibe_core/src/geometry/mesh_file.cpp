#include "vibe_core/geometry/mesh_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>

#include "geometry/assimp_reader.hpp"
#include "geometry/mesh_header.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr double kWeldTolerance = 1e-6;  // relative to the size of the surface

void checkFile(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw Error("geometry.file: " + path + " does not exist; give the path of a mesh file");
  }
  if (!std::filesystem::is_regular_file(path, ignored) || !std::ifstream(path).good()) {
    throw Error("geometry.file: " + path + " cannot be read; check that it is a file and its permissions");
  }
  std::string type = std::filesystem::path(path).extension().string();
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return std::tolower(c); });
  static const std::array<const char*, 5> known{".obj", ".stl", ".ply", ".gltf", ".glb"};
  if (std::find(known.begin(), known.end(), type) == known.end()) {
    throw Error("geometry.file: " + path + " is not of a type that can be read; convert it to OBJ, STL, PLY or glTF");
  }
  checkMeshHeader(path, type);
}

using Cell = std::array<std::int64_t, 3>;

/// Number of an earlier vertex within the tolerance, or -1.
int findNear(const std::map<Cell, std::vector<int>>& cells, const Cell& cell, const Eigen::Vector3d& p,
             const std::vector<Eigen::Vector3d>& kept, double tolerance) {
  for (std::int64_t x = -1; x <= 1; ++x) {
    for (std::int64_t y = -1; y <= 1; ++y) {
      for (std::int64_t z = -1; z <= 1; ++z) {
        const auto found = cells.find({cell[0] + x, cell[1] + y, cell[2] + z});
        if (found == cells.end()) continue;
        for (const int v : found->second) {
          if ((kept[v] - p).norm() <= tolerance) return v;
        }
      }
    }
  }
  return -1;
}

SurfaceMesh dropUnused(const SurfaceMesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1);
  SurfaceMesh kept;
  for (auto t : mesh.triangles) {
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(kept.vertices.size());
        kept.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    kept.triangles.push_back(t);
  }
  return kept;
}

}  // namespace

SurfaceMesh weld(const SurfaceMesh& mesh, double tolerance) {
  SurfaceMesh merged;
  if (mesh.vertices.empty()) return merged;
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v);
  // at most 2^40 cells per side, so that the cell numbers are exact
  const double cell_size = std::max({tolerance, box.sizes().maxCoeff() * 1e-12, 1e-300});
  std::map<Cell, std::vector<int>> cells;
  std::vector<int> number;
  for (const auto& p : mesh.vertices) {
    const Eigen::Vector3d scaled = (p - box.min()) / cell_size;
    const Cell cell{static_cast<std::int64_t>(scaled.x()), static_cast<std::int64_t>(scaled.y()),
                    static_cast<std::int64_t>(scaled.z())};
    int v = findNear(cells, cell, p, merged.vertices, tolerance);
    if (v < 0) {
      v = static_cast<int>(merged.vertices.size());
      merged.vertices.push_back(p);
      cells[cell].push_back(v);
    }
    number.push_back(v);
  }
  for (const auto& t : mesh.triangles) {
    const std::array<int, 3> n{number[t[0]], number[t[1]], number[t[2]]};
    if (n[0] != n[1] && n[1] != n[2] && n[2] != n[0]) merged.triangles.push_back(n);
  }
  return dropUnused(merged);
}

SurfaceMesh readMeshFile(const std::string& path) {
  checkFile(path);
  const SurfaceMesh raw = readWithAssimp(path);
  checkNumbers(raw, path);
  Eigen::AlignedBox3d box;
  for (const auto& v : raw.vertices) box.extend(v);
  SurfaceMesh mesh = weld(raw, kWeldTolerance * box.sizes().maxCoeff());
  checkNumbers(mesh, path);
  return mesh;
}

bool statesMetres(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".glb" || extension == ".gltf";
}

}  // namespace vibe
