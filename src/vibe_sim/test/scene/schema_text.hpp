#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "vibe_sim/scene/scene_parser.hpp"
#include "vibe_sim/scene/schema.hpp"

namespace vibe {

/// A valid scene in which a row applies: its section is present and geometry.kind fits.
inline Scene sceneFor(const SchemaRow& row) {
  Scene scene;
  scene.geometry.kind = row.only_for.value_or(GeometryScene::Kind::Stomach);
  if (scene.geometry.kind == GeometryScene::Kind::Mesh) {
    scene.geometry.file = "organ.obj";
    scene.geometry.oesophagus = scene.geometry.fundus = scene.geometry.incisura = scene.geometry.pylorus =
        Eigen::Vector3d(1, 2, 3);
  }
  const std::string section = sectionOf(row.key);
  if (section == "helix" || section == "scope.base") scene.scope.emplace();
  findSection(section)->enter(scene);
  return scene;
}

/// A scene text that has the row's key with the given YAML value, and the line where it stands (from 1).
struct SceneText {
  std::string yaml;
  int line = 0;
};

/// The text of sceneFor(row) with the key's value replaced; an empty value leaves the key out.
inline SceneText textWith(const SchemaRow& row, const std::string& value) {
  std::istringstream lines(toYaml(sceneFor(row)));
  const std::string section = sectionOf(row.key);
  const std::string entry = value.empty() ? "" : lastPart(row.key) + ": " + value + "\n";
  std::vector<std::string> open;  // the sections around a line
  SceneText result;
  int number = 0;
  const auto insert = [&](std::size_t indent) {
    if (entry.empty()) return;
    result.yaml += std::string(indent, ' ') + entry;
    result.line = ++number;
  };
  if (section.empty()) insert(0);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    const std::string key = line.substr(indent, line.find(':') - indent);
    open.resize(indent / 2);
    std::string path;
    for (const std::string& part : open) path += part + ".";
    path += key;
    if (path == row.key) continue;
    result.yaml += line + "\n";
    ++number;
    if (line.back() == ':') open.push_back(key);
    if (path == section) insert(indent + 2);
  }
  return result;
}

}  // namespace vibe
