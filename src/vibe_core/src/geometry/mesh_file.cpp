#include "vibe_core/geometry/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <Eigen/Geometry>

#include "geometry/assimp_reader.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

/// Checks the header of a mesh file against the file size before the file is read in full. On some damaged headers the
/// reader of the import library does not terminate, or requests all memory.
/// @param type lower-case extension with its dot; files of a type without header are accepted
/// @throws Error naming the file, the place and the remedy.
void checkMeshHeader(const std::string& path, const std::string& type);

namespace {

constexpr std::size_t kLongestHeader = 1 << 16;  // bytes

[[noreturn]] void reject(const std::string& path, const std::string& what) {
  throw Error("geometry.file: " + path + " is damaged: " + what + "; export it again");
}

std::string beginning(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text(kLongestHeader, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::uint32_t number(const std::string& bytes, std::size_t place) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof value);  // little endian, like the supported processors
  return value;
}

bool isPlyType(const std::string& word) {
  static const std::array<const char*, 16> known{"char",  "uchar",  "short",   "ushort", "int",   "uint",
                                                 "float", "double", "int8",    "uint8",  "int16", "uint16",
                                                 "int32", "uint32", "float32", "float64"};
  return std::find(known.begin(), known.end(), word) != known.end();
}

bool isPlyLine(const std::string& line, std::uintmax_t size) {
  std::istringstream words(line);
  std::string key, a, b, c, d;
  words >> key;
  if (key == "comment" || key == "obj_info") return true;
  words >> a >> b;
  if (key == "format") return (a == "ascii" || a == "binary_little_endian" || a == "binary_big_endian") && b == "1.0";
  if (key == "element") {
    const bool digits = !b.empty() && b.size() < 12 && b.find_first_not_of("0123456789") == std::string::npos;
    return digits && std::stoull(b) <= size;  // every element takes at least a byte
  }
  if (key != "property") return false;
  if (a != "list") return isPlyType(a) && !b.empty();
  words >> c >> d;
  return isPlyType(b) && isPlyType(c) && !d.empty();
}

void checkPly(const std::string& path, const std::string& text, std::uintmax_t size) {
  std::istringstream in(text);
  std::string line;
  for (int number_of_line = 1; std::getline(in, line); ++number_of_line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number_of_line == 1 ? line == "ply" : isPlyLine(line, size)) continue;
    if (line == "end_header" && number_of_line > 1) return;
    reject(path, "line " + std::to_string(number_of_line) + " of its header is not understood");
  }
  reject(path, "its header does not end");
}

void checkGlb(const std::string& path, const std::string& text, std::uintmax_t size) {
  if (text.size() < 20 || text.compare(0, 4, "glTF") != 0) reject(path, "it does not begin like a GLB file");
  if (number(text, 8) != size) {
    reject(path, "it states " + std::to_string(number(text, 8)) + " bytes but has " + std::to_string(size));
  }
  if (number(text, 12) > size - 20) reject(path, "its first part is longer than the file");
}

void checkStl(const std::string& path, const std::string& text, std::uintmax_t size) {
  const std::uintmax_t stated = text.size() >= 84 ? 84 + 50 * static_cast<std::uintmax_t>(number(text, 80)) : 0;
  if (stated == size || text.compare(0, 5, "solid") == 0) return;
  reject(path, stated == 0 ? "it is too short"
                           : "its triangles would take " + std::to_string(stated) + " bytes but it has " +
                                 std::to_string(size));
}

}  // namespace

void checkMeshHeader(const std::string& path, const std::string& type) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) reject(path, "its size cannot be found");
  const std::string text = beginning(path);
  if (type == ".ply") checkPly(path, text, size);
  if (type == ".glb") checkGlb(path, text, size);
  if (type == ".stl") checkStl(path, text, size);
}

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
