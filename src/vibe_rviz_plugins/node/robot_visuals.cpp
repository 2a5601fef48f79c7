#include "robot_visuals.hpp"

#include <urdf/model.h>

#include "vibe_rviz_plugins/geometry/solid_bodies.hpp"

namespace vibe::rviz_plugins {
namespace {

Eigen::Isometry3d toPose(const urdf::Pose& origin) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(origin.position.x, origin.position.y, origin.position.z));
  double x, y, z, w;
  origin.rotation.getQuaternion(x, y, z, w);
  pose.rotate(Eigen::Quaterniond(w, x, y, z).normalized());
  return pose;
}

PackedColour colourOf(const urdf::Visual& visual) {
  if (!visual.material) return packed(0.6, 0.6, 0.62);
  const urdf::Color& colour = visual.material->color;
  return packed(colour.r, colour.g, colour.b);
}

RobotVisual readVisual(const std::string& link, const urdf::Visual& visual) {
  RobotVisual result;
  result.link = link;
  result.part = visual.name.empty() ? link : link + "/" + visual.name;
  result.pose = toPose(visual.origin);
  const PackedColour colour = colourOf(visual);
  if (const auto* ball = dynamic_cast<const urdf::Sphere*>(visual.geometry.get())) {
    appendSphere(result.pose, ball->radius, colour, result.body);
  } else if (const auto* rod = dynamic_cast<const urdf::Cylinder*>(visual.geometry.get())) {
    appendCylinder(result.pose, rod->radius, rod->length, colour, result.body);
  } else if (const auto* box = dynamic_cast<const urdf::Box*>(visual.geometry.get())) {
    appendBox(result.pose, {box->dim.x, box->dim.y, box->dim.z}, colour, result.body);
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

}  // namespace vibe::rviz_plugins
