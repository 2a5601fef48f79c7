#pragma once
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_testing/temporary_folder.hpp"

namespace vibe::test {

inline std::string toObj(const SurfaceMesh& mesh) {
  std::ostringstream out;
  out << std::setprecision(9) << "o surface\n";
  for (const auto& v : mesh.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& t : mesh.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return out.str();
}

inline std::string toPly(const SurfaceMesh& mesh) {
  std::ostringstream out;
  out << std::setprecision(9) << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& v : mesh.vertices) out << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return out.str();
}

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

inline void appendPoint(std::string& bytes, const Eigen::Vector3d& p) {
  for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(p[k]));
}

/// Binary; every triangle has its own corners, as the format wants it.
inline std::string toStl(const SurfaceMesh& mesh) {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    appendPoint(bytes, Eigen::Vector3d::Zero());
    for (const int v : t) appendPoint(bytes, mesh.vertices[v]);
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

/// One mesh under a node with this matrix (16 numbers, column by column; empty: none).
inline std::string toGlb(const SurfaceMesh& mesh, const std::string& matrix = "") {
  std::string data;
  for (const auto& t : mesh.triangles) {
    for (const int v : t) append(data, static_cast<std::uint32_t>(v));
  }
  const std::size_t index_bytes = data.size();
  Eigen::Vector3d low = mesh.vertices[0], high = low;
  for (const auto& v : mesh.vertices) {
    appendPoint(data, v);
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  std::ostringstream json;
  json << std::setprecision(9) << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)"
       << (matrix.empty() ? "" : R"(,"matrix":[)" + matrix + "]")
       << R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],"buffers":[{"byteLength":)"
       << data.size() << R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << index_bytes
       << R"(},{"buffer":0,"byteOffset":)" << index_bytes << R"(,"byteLength":)" << data.size() - index_bytes
       << R"(}],"accessors":[{"bufferView":0,"componentType":5125,"count":)" << 3 * mesh.triangles.size()
       << R"(,"type":"SCALAR"},{"bufferView":1,"componentType":5126,"count":)" << mesh.vertices.size()
       << R"(,"type":"VEC3","min":[)" << low.x() << ',' << low.y() << ',' << low.z() << R"(],"max":[)" << high.x()
       << ',' << high.y() << ',' << high.z() << "]}]}";
  std::string text = json.str();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + data.size()));
  append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append(bytes, static_cast<std::uint32_t>(data.size()));
  bytes += std::string("BIN\0", 4) + data;
  return bytes;
}

}  // namespace vibe::test
