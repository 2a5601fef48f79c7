#include "mesh_capsules.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

namespace vibe::web {

std::vector<graphics::Capsule> meshCapsules(const std::string& file) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(file, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices);
  if (scene == nullptr) return {};
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> triangles;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(points.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      points.emplace_back(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned k = 0; mesh.mFaces[f].mNumIndices == 3 && k < 3; ++k)
        triangles.push_back(first + mesh.mFaces[f].mIndices[k]);
  }
  return graphics::fitCapsules(points, triangles);
}

}  // namespace vibe::web
