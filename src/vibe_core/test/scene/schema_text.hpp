#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"

namespace vibe {

/// The section, those around it and those that it needs.
inline void enterWithNeeds(const std::string& name, Scene& scene) {
  const SchemaSection& section = *findSection(name);
  if (!name.empty() && name != sectionOf(name)) enterWithNeeds(sectionOf(name), scene);
  if (section.needs != nullptr) enterWithNeeds(section.needs, scene);
  if (name.empty() || !section.isPresent(scene)) section.enter(scene);
}

/// Moves what a key is compared with out of its way, so that all of its range is allowed.
inline void makeRoom(const std::string& key, Scene& scene) {
  if (scene.suture && key == "suture.min_bites") scene.suture->max_bites = 1000;
  if (scene.suture && key == "suture.max_bites") scene.suture->min_bites = 2;
  if (scene.suture && key == "suture.loose_tension") scene.suture->cinch_tension = 1000;
  if (scene.suture && key == "suture.loose_tension") scene.suture->thread_strength = 1000;
  if (scene.suture && key == "suture.cinch_tension") scene.suture->loose_tension = 0;
  if (scene.suture && key == "suture.cinch_tension") scene.suture->thread_strength = 1000;
  if (scene.suture && key == "suture.thread_strength") scene.suture->loose_tension = 0;
  if (scene.suture && key == "suture.thread_strength") scene.suture->cinch_tension = 0.02;
  if (scene.marking && key == "marking.mark_energy")
    scene.marking->apc.burn_energy = scene.marking->apc.deep_energy = 1e5;
  if (scene.marking && key == "marking.burn_energy") scene.marking->apc.mark_energy = 1e-3;
  if (scene.marking && key == "marking.burn_energy") scene.marking->apc.deep_energy = 1e5;
  if (scene.marking && key == "marking.deep_energy")
    scene.marking->apc.mark_energy = scene.marking->apc.burn_energy = 1e-3;
  if (scene.bleeding && key == "bleeding.mild_probability") scene.bleeding->brisk_probability = 0;
  if (scene.bleeding && key == "bleeding.brisk_probability") scene.bleeding->mild_probability = 0;
}

/// A valid scene in which a row applies: its section is present and geometry.kind fits.
inline Scene sceneFor(const SchemaRow& row) {
  Scene scene;
  scene.geometry.kind = row.only_for.value_or(GeometryScene::Kind::Stomach);
  if (scene.geometry.kind == GeometryScene::Kind::Mesh) {
    scene.geometry.file = "organ.obj";
    scene.geometry.oesophagus = scene.geometry.fundus = scene.geometry.incisura = scene.geometry.pylorus =
        Eigen::Vector3d(1, 2, 3);
  }
  enterWithNeeds(sectionOf(row.key), scene);
  makeRoom(row.key, scene);
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
