#include "scene_text.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <urdf/model.h>

#include "mesh_capsules.hpp"
#include "operator/operator_seat.hpp"
#include "vibe_graphics/geometry/endoscope_optics.hpp"
#include "vibe_graphics/geometry/mucosa_map.hpp"
#include "vibe_graphics/geometry/mucosa_pattern.hpp"
#include "vibe_operator/drive/scope_drive.hpp"
#include "vibe_ros_utils/mesh_address.hpp"

namespace vibe::web {

using nlohmann::json;

namespace {

constexpr int kPicture = 720;  // edge of the endoscope's picture for which the numbers of the lens are told [px]

json placeOf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

json turnOf(const urdf::Rotation& r) {
  return {r.x, r.y, r.z, r.w};
}

json jointOf(const urdf::Joint& joint) {
  const urdf::Pose& origin = joint.parent_to_joint_origin_transform;
  const bool turns = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
  json link = {{"name", joint.child_link_name},
               {"parent", joint.parent_link_name},
               {"joint", joint.name},
               {"type", turns                                  ? "turn"
                        : joint.type == urdf::Joint::PRISMATIC ? "slide"
                                                               : "fixed"},
               {"place", placeOf(origin.position)},
               {"turn", turnOf(origin.rotation)},
               {"axis", placeOf(joint.axis)}};
  if (joint.mimic)
    link["mimic"] = {
        {"joint", joint.mimic->joint_name}, {"factor", joint.mimic->multiplier}, {"offset", joint.mimic->offset}};
  return link;
}

/// Where the server has a file: each folder has a number, because parts of two packages may have the same name.
std::string pathOf(const std::string& file, RobotText& robot) {
  const std::string folder = file.substr(0, file.rfind('/'));
  const std::size_t number = robot.folders.emplace(folder, robot.folders.size()).first->second;
  std::string path = "/mesh/" + std::to_string(number) + file.substr(folder.size());
  robot.meshes[path] = file;
  return path;
}

/// The material files that an OBJ names, which stand beside it.
void addMaterials(const std::string& file, RobotText& robot) {
  std::ifstream stream(file);
  const std::string word = "mtllib ";
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(word, 0) != 0) continue;
    const std::string name = line.substr(word.size(), line.find_last_not_of(" \r") + 1 - word.size());
    if (name.find('/') == std::string::npos) pathOf(file.substr(0, file.rfind('/') + 1) + name, robot);
  }
}

json capsuleText(const std::string& file) {
  json text = json::array();
  for (const graphics::Capsule& c : meshCapsules(file))
    text.push_back({c.from.x(), c.from.y(), c.from.z(), c.to.x(), c.to.y(), c.to.z(), c.radius});
  return text;
}

void addMesh(const std::string& address, json& visual, RobotText& robot) {
  const std::string file = ros_utils::fileOf(address);
  std::error_code error;
  const bool known =
      file.size() > 4 && file.substr(file.size() - 4) == ".obj" && std::filesystem::is_regular_file(file, error);
  if (!known) {
    robot.problems.push_back("The mesh '" + address +
                             "' of the robot description is missing on the page, which reads " +
                             "OBJ files; convert it, or correct its path.");
    return;
  }
  visual["mesh"] = pathOf(file, robot);
  visual["capsules"] = capsuleText(file);
  addMaterials(file, robot);
}

json visualOf(const std::string& link, const urdf::Visual& visual, RobotText& robot) {
  json text = {{"link", link},
               {"place", placeOf(visual.origin.position)},
               {"turn", turnOf(visual.origin.rotation)},
               {"scale", {1, 1, 1}},
               {"colour", {0.6, 0.6, 0.62}}};
  if (visual.material) {
    const urdf::Color& colour = visual.material->color;
    text["colour"] = {colour.r, colour.g, colour.b};
  }
  if (const auto* ball = dynamic_cast<const urdf::Sphere*>(visual.geometry.get())) {
    text["sphere"] = {ball->radius};
  } else if (const auto* rod = dynamic_cast<const urdf::Cylinder*>(visual.geometry.get())) {
    text["cylinder"] = {rod->radius, rod->length};
  } else if (const auto* box = dynamic_cast<const urdf::Box*>(visual.geometry.get())) {
    text["box"] = placeOf(box->dim);
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(visual.geometry.get())) {
    text["scale"] = placeOf(mesh->scale);
    addMesh(mesh->filename, text, robot);
  }
  return text;
}

json sourceText(const graphics::SquareSource& source) {
  return {{"half_width", source.half_width}, {"size", source.size}};
}

json lensText() {
  graphics::RoundCamera camera;
  camera.width = camera.height = kPicture;
  const graphics::LensSources sources = graphics::sourcesFor(camera, 1, 4096);
  using graphics::AutoExposure;
  return {{"size", kPicture},
          {"field_of_view", camera.field_of_view},
          {"whole", sourceText(sources.whole)},
          {"middle", sourceText(sources.middle)},
          {"exposure",
           {{"target", AutoExposure::kTarget},
            {"rate", AutoExposure::kRate},
            {"gap", AutoExposure::kGap},
            {"first", AutoExposure::kFixedGain},
            {"min", AutoExposure::kMinGain},
            {"max", AutoExposure::kMaxGain}}}};
}

json keyText() {
  using Binding = operating::KeyBinding;
  json keys = json::array(), rows = json::array();
  for (const Binding& key : operating::keyBindings()) {
    const char* kind = key.kind == Binding::Kind::Joint    ? "joint"
                       : key.kind == Binding::Kind::Button ? "button"
                       : key.kind == Binding::Kind::Gear   ? "gear"
                                                           : "slow";
    keys.push_back({{"key", key.key}, {"kind", kind}, {"index", key.index}, {"sign", key.sign}});
  }
  for (const operating::KeyRow& row : operating::keyRows()) {
    json caps = json::array();
    for (const auto& cap : row.caps) caps.push_back({{"key", cap.key}, {"label", cap.label}});
    rows.push_back({{"caps", caps}, {"text", row.text}});
  }
  return {{"bindings", keys}, {"rows", rows}};
}

}  // namespace

RobotText readRobot(const std::string& description) {
  urdf::Model model;
  if (description.empty() || !model.initString(description))
    throw std::runtime_error(
        "The parameter robot_description holds no URDF that can be read, so the page shows no endoscope.");
  RobotText robot;
  robot.json = {{"links", json::array()}, {"visuals", json::array()}};
  for (const auto& [name, joint] : model.joints_) robot.json["links"].push_back(jointOf(*joint));
  for (const auto& [name, link] : model.links_)
    for (const auto& visual : link->visual_array)
      if (visual && visual->geometry) robot.json["visuals"].push_back(visualOf(name, *visual, robot));
  return robot;
}

json constantText() {
  return {{"lens", lensText()},
          {"keys", keyText()},
          {"tallest_fold", graphics::kTallestFold},
          {"pattern", {{"size", graphics::kPatternSize}}},
          {"silence", kDeadMan}};
}

}  // namespace vibe::web
