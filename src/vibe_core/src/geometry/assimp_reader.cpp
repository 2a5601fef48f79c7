#include "geometry/assimp_reader.hpp"

#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "geometry/isolated.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

void append(SurfaceMesh& mesh, const aiMesh& part, const aiMatrix4x4& transform) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D p = transform * part.mVertices[v];
    mesh.vertices.emplace_back(p.x, p.y, p.z);
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    // polygons become fans; points and lines have none
    for (unsigned k = 2; k < face.mNumIndices; ++k) {
      mesh.triangles.push_back({first + static_cast<int>(face.mIndices[0]),
                                first + static_cast<int>(face.mIndices[k - 1]),
                                first + static_cast<int>(face.mIndices[k])});
    }
  }
}

void append(SurfaceMesh& mesh, const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned k = 0; k < node.mNumMeshes; ++k) append(mesh, *scene.mMeshes[node.mMeshes[k]], transform);
  for (unsigned k = 0; k < node.mNumChildren; ++k) append(mesh, scene, *node.mChildren[k], transform);
}

SurfaceMesh readHere(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) throw Error(importer.GetErrorString());
  SurfaceMesh mesh;
  append(mesh, *scene, *scene->mRootNode, aiMatrix4x4());
  return mesh;
}

template <class T>
void put(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
void take(const std::string& bytes, std::size_t& place, T* values, std::size_t count) {
  if (count > (bytes.size() - place) / sizeof(T)) throw Error("its content does not come through");
  if (count > 0) std::memcpy(values, bytes.data() + place, count * sizeof(T));
  place += count * sizeof(T);
}

std::string pack(const SurfaceMesh& mesh) {
  const std::uint64_t counts[2] = {mesh.vertices.size(), mesh.triangles.size()};
  std::string bytes;
  put(bytes, counts, 2);
  for (const auto& v : mesh.vertices) put(bytes, v.data(), 3);
  for (const auto& t : mesh.triangles) put(bytes, t.data(), 3);
  return bytes;
}

SurfaceMesh unpack(const std::string& bytes) {
  std::uint64_t counts[2] = {0, 0};
  std::size_t place = 0;
  take(bytes, place, counts, 2);
  SurfaceMesh mesh;
  for (std::uint64_t k = 0; k < counts[0]; ++k) {
    mesh.vertices.emplace_back();
    take(bytes, place, mesh.vertices.back().data(), 3);
  }
  for (std::uint64_t k = 0; k < counts[1]; ++k) {
    mesh.triangles.emplace_back();
    take(bytes, place, mesh.triangles.back().data(), 3);
  }
  return mesh;
}

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, ' ');
  return text;
}

}  // namespace

SurfaceMesh readWithAssimp(const std::string& path) {
  std::error_code ignored;
  const auto megabytes = static_cast<unsigned>(std::filesystem::file_size(path, ignored) >> 20);
  WorkLimits limits;
  limits.seconds = 20 + megabytes / 2;
  limits.memory += std::size_t{100} * megabytes << 20;
  try {
    return unpack(runIsolated([&] { return pack(readHere(path)); }, limits));
  } catch (const Error& e) {
    throw Error("geometry.file: " + path + " cannot be read (" + oneLine(e.what()) + "); export it again");
  }
}

}  // namespace vibe
