#include "robot_shapes.hpp"

#include <map>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <urdf/model.h>
#include <assimp/Importer.hpp>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_ros_utils/mesh_address.hpp"

namespace vibe::endoscope {

namespace {

Eigen::Isometry3d toPose(const urdf::Pose& origin) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(origin.position.x, origin.position.y, origin.position.z));
  double x, y, z, w;
  origin.rotation.getQuaternion(x, y, z, w);
  pose.rotate(Eigen::Quaterniond(w, x, y, z).normalized());
  return pose;
}

graphics::PackedColour colourOf(const urdf::Visual& visual) {
  if (!visual.material) return graphics::packed(0.6, 0.6, 0.62);
  const urdf::Color& colour = visual.material->color;
  return graphics::packed(colour.r, colour.g, colour.b);
}

RobotVisual readVisual(const std::string& link, const urdf::Visual& visual) {
  RobotVisual result;
  result.link = link;
  result.part = visual.name.empty() ? link : link + "/" + visual.name;
  result.pose = toPose(visual.origin);
  const graphics::PackedColour colour = colourOf(visual);
  if (const auto* ball = dynamic_cast<const urdf::Sphere*>(visual.geometry.get())) {
    graphics::appendSphere(result.pose, ball->radius, colour, result.body);
  } else if (const auto* rod = dynamic_cast<const urdf::Cylinder*>(visual.geometry.get())) {
    graphics::appendCylinder(result.pose, rod->radius, rod->length, colour, result.body);
  } else if (const auto* box = dynamic_cast<const urdf::Box*>(visual.geometry.get())) {
    graphics::appendBox(result.pose, {box->dim.x, box->dim.y, box->dim.z}, colour, result.body);
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(visual.geometry.get())) {
    result.mesh = mesh->filename;
    result.scale = {mesh->scale.x, mesh->scale.y, mesh->scale.z};
  }
  return result;
}

}  // namespace

std::optional<std::vector<RobotVisual>> robotVisuals(const std::string& description) {
  urdf::Model model;
  if (description.empty() || !model.initString(description)) return std::nullopt;
  std::vector<RobotVisual> visuals;
  for (const auto& [name, link] : model.links_)
    for (const auto& visual : link->visual_array)
      if (visual && visual->geometry) visuals.push_back(readVisual(name, *visual));
  return visuals;
}

namespace {

void appendMesh(const aiMesh& mesh, const aiMatrix4x4& pose, const Eigen::Affine3d& place,
                graphics::ColouredShape& shape) {
  const auto first = static_cast<std::uint32_t>(shape.vertices.size());
  const Eigen::Matrix3d turn = place.linear().inverse().transpose();
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D point = pose * mesh.mVertices[v];
    const aiVector3D normal = mesh.HasNormals() ? aiMatrix3x3(pose) * mesh.mNormals[v] : aiVector3D(0, 0, 0);
    const Eigen::Vector3f p = (place * Eigen::Vector3d(point.x, point.y, point.z)).cast<float>();
    const Eigen::Vector3f n = (turn * Eigen::Vector3d(normal.x, normal.y, normal.z)).normalized().cast<float>();
    shape.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
    shape.colours.push_back(graphics::packed(0.6, 0.6, 0.62));
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f)
    for (unsigned k = 0; mesh.mFaces[f].mNumIndices == 3 && k < 3; ++k)
      shape.triangles.push_back(first + mesh.mFaces[f].mIndices[k]);
}

void appendNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, const Eigen::Affine3d& place,
                graphics::ColouredShape& shape) {
  const aiMatrix4x4 pose = parent * node.mTransformation;
  for (unsigned k = 0; k < node.mNumMeshes; ++k) appendMesh(*scene.mMeshes[node.mMeshes[k]], pose, place, shape);
  for (unsigned k = 0; k < node.mNumChildren; ++k) appendNode(scene, *node.mChildren[k], pose, place, shape);
}

/// @return one sentence if the mesh cannot be read
std::string appendMeshFile(const RobotVisual& visual, graphics::ColouredShape& shape) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // as rviz
  const aiScene* scene = importer.ReadFile(ros_utils::fileOf(visual.mesh),
                                           aiProcess_SortByPType | aiProcess_GenNormals | aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr)
    return "The mesh '" + visual.mesh + "' of the robot description cannot be read (" + importer.GetErrorString() +
           ") and is missing in the truth; correct the path or install its package.";
  Eigen::Affine3d place(visual.pose);
  place.scale(visual.scale);
  appendNode(*scene, *scene->mRootNode, aiMatrix4x4(), place, shape);
  return "";
}

}  // namespace

std::vector<RobotShape> robotShapes(const std::string& description, std::vector<std::string>& problems) {
  std::vector<RobotShape> shapes;
  const std::optional<std::vector<RobotVisual>> visuals = robotVisuals(description);
  if (!visuals) {
    problems.push_back(
        "The parameter 'robot_description' holds no URDF that can be read, so no instrument is in the truth.");
    return shapes;
  }
  std::map<std::pair<std::string, std::string>, graphics::ColouredShape> parts;  // by link and part
  for (const RobotVisual& visual : *visuals) {
    graphics::ColouredShape& shape = parts[{visual.link, visual.part}];
    const std::string problem = visual.mesh.empty() ? "" : appendMeshFile(visual, shape);
    if (!problem.empty()) problems.push_back(problem);
    graphics::appendShape(visual.body, shape);
  }
  for (auto& [name, shape] : parts)
    if (!shape.triangles.empty()) shapes.push_back({name.first, name.second, std::move(shape)});
  return shapes;
}

}  // namespace vibe::endoscope
