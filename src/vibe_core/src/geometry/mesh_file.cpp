#include "vibe_core/geometry/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include "geometry/mesh_readers.hpp"
#include "geometry/surface_check.hpp"
#include "geometry/text_lines.hpp"
#include "vibe_core/files/foreign_content.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

namespace fs = std::filesystem;

constexpr double kWeldTolerance = 1e-6;              // relative to the size of the surface
constexpr std::uintmax_t kLargestFile = 1U << 30;    // bytes
constexpr std::size_t kLongestBeginning = 1U << 14;  // bytes in which comments are looked for

std::string typeOf(const std::string& path) {
  return lowered(fs::path(path).extension().string());
}

/// The content of a file.
/// @throws Error, as a clause, if it cannot be read or is something else in its place
std::string readContent(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in) throw Error("cannot be read; check that it is a file and its permissions");
  if (size > kLargestFile) throw Error("is larger than 1 GiB; reduce the surface");
  std::string content(size, '\0');
  in.read(content.data(), static_cast<std::streamsize>(size));
  content.resize(static_cast<std::size_t>(in.gcount()));
  const std::string foreign = foreignContent(content);
  if (!foreign.empty()) throw Error(foreign);
  return content;
}

/// A file that a glTF names, from its folder and below only: a file from elsewhere may name any other of this machine.
std::string readBeside(const std::string& path, const std::string& name) {
  const fs::path folder = fs::weakly_canonical(path).parent_path(), file = fs::weakly_canonical(folder / name);
  if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end())
    throw Error("it names " + shown(name) + ", which is not in its folder; put it there, or export as GLB");
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw Error("it names " + shown(name) + ", which does not exist; put it beside this file, or export as GLB");
  try {
    return readContent(file);
  } catch (const Error& e) {
    throw Error("the file " + shown(name) + ", which it names, " + e.what());
  }
}

/// A file whose beginning is that of another format than its name says.
void checkType(const std::string& type, const std::string& content) {
  const auto begins = [&](std::string_view beginning) { return content.compare(0, beginning.size(), beginning) == 0; };
  const char* other = begins("ply\n") || begins("ply\r") ? ".ply" : begins("glTF") ? ".glb" : nullptr;
  if (other == nullptr || type == other || (type == ".gltf" && begins("glTF"))) return;
  throw Error(std::string("begins like a file of the type ") + other + "; give it a name that ends so");
}

SurfaceMesh readByType(const std::string& path, const std::string& type) {
  const std::string content = readContent(path);
  checkType(type, content);
  if (type == ".obj") return readObj(content);
  if (type == ".stl") return readStl(content);
  if (type == ".ply") return readPly(content);
  return readGltf(content, [&path](const std::string& name) { return readBeside(path, name); });
}

/// The triangles of a file, as they are there.
SurfaceMesh readRaw(const std::string& path) {
  const auto fail = [&path](const std::string& what) { throw Error("geometry.file: " + path + " " + what); };
  std::error_code ignored;
  if (!fs::exists(path, ignored)) fail("does not exist; give the path of a mesh file");
  if (!fs::is_regular_file(path, ignored)) fail("cannot be read, it is not a file; give the path of a mesh file");
  static const std::array<const char*, 5> known{".obj", ".stl", ".ply", ".gltf", ".glb"};
  const std::string type = typeOf(path);
  if (std::find(known.begin(), known.end(), type) == known.end())
    fail("is not of a type that can be read; convert it to OBJ, STL, PLY or glTF");
  try {
    return readByType(path, type);
  } catch (const Error& e) {
    throw Error("geometry.file: " + path + ": " + e.what());
  } catch (const std::bad_alloc&) {
    throw Error("geometry.file: " + path + ": needs more memory than there is; reduce the surface");
  }
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

SurfaceMesh weld(const SurfaceMesh& raw, double part) {
  const SurfaceMesh mesh = dropUnused(raw);  // those may have any positions, and are not checked
  SurfaceMesh merged;
  if (mesh.vertices.empty()) return merged;
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v);
  const double size = box.sizes().maxCoeff(), tolerance = part * size;
  // at most 2^40 cells per side, so that the cell numbers are exact
  const double cell_size = std::max({tolerance, size * 1e-12, 1e-300});
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
  const SurfaceMesh raw = readRaw(path);
  checkNumbers(raw, path);
  SurfaceMesh mesh = weld(raw, kWeldTolerance);
  if (mesh.triangles.empty()) throw Error(path + " has only triangles without area; check that it is the right file");
  return mesh;
}

bool statesMetres(const std::string& path) {
  const std::string type = typeOf(path);
  return type == ".glb" || type == ".gltf";
}

std::array<double, 3> rotationOf(PatientAxes axes) {
  return {0, 0, axes == PatientAxes::Ras ? -M_PI / 2 : M_PI / 2};
}

std::optional<PatientAxes> statedAxes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string content(kLongestBeginning, '\0');
  in.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(in.gcount()));
  const std::string type = typeOf(path);
  const std::string_view comment = type == ".obj" ? "#" : type == ".ply" ? "comment" : "";
  TextLines lines(type == ".stl" ? std::string_view(content).substr(0, 80) : std::string_view(content));
  while (!statesMetres(path) && lines.next()) {
    if (lines.line().substr(0, comment.size()) != comment) continue;
    if (lines.line().find("SPACE=RAS") != std::string_view::npos) return PatientAxes::Ras;
    if (lines.line().find("SPACE=LPS") != std::string_view::npos) return PatientAxes::Lps;
    if (type == ".stl") break;  // only in the name of the solid or the header
  }
  return std::nullopt;
}

}  // namespace vibe
