#include "vibe_core/scene/mesh_override.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "scene/scene_value.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/scene/nearest_key.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {
namespace {

/// Keys of `geometry` that describe a surface file; a sidecar file has them at its top level.
const std::vector<std::string> kSidecarKeys{"unit", "target_volume", "rotation_rpy", "landmarks"};
const std::vector<std::string> kLandmarkKeys{"oesophagus", "fundus", "incisura", "pylorus"};

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void readKeys(const YamlSource& source, const YamlField& map, const std::vector<std::string>& allowed, Scene& scene) {
  for (const YamlField& field : source.map(map)) {
    if (!contains(allowed, field.key)) source.fail(field, "is not a known key; " + suggestKey(field.key, allowed));
    if (field.key == "landmarks") {
      readKeys(source, field, kLandmarkKeys, scene);
    } else {
      readValue(source, field, *findRow("geometry." + field.path), scene);
    }
  }
}

bool existsAsFile(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string missingLandmarks(const GeometryScene& geometry) {
  std::string list;
  const auto note = [&list](bool given, const char* name) {
    if (!given) list += std::string(list.empty() ? "" : ", ") + name + ": [x, y, z]";
  };
  note(geometry.oesophagus.has_value(), "oesophagus");
  note(geometry.fundus.has_value(), "fundus");
  note(geometry.incisura.has_value(), "incisura");
  note(geometry.pylorus.has_value(), "pylorus");
  return list;
}

void checkComplete(const GeometryScene& geometry, const std::string& mesh_file) {
  // A target volume determines the scale without a unit.
  const bool lacks_unit = geometry.unit == 0 && geometry.target_volume == 0 && !statesMetres(mesh_file);
  const std::string points = missingLandmarks(geometry);
  if (!lacks_unit && points.empty()) return;
  std::string remedy = lacks_unit ? "'unit: 1 mm' (or what one unit of the file is)" : "";
  if (!points.empty()) remedy += (remedy.empty() ? "" : " and ") + ("'landmarks: {" + points + "}'");
  throw Error(mesh_file + ": the simulator cannot know " + (lacks_unit ? "its unit" : "") +
              (lacks_unit && !points.empty() ? " and " : "") + (points.empty() ? "" : "its landmarks") + "; write " +
              remedy + ", in the file's own axes and unit, into " + sidecarOf(mesh_file) +
              " or use a scene with 'geometry: {kind: mesh}' that states them");
}

}  // namespace

std::string sidecarOf(const std::string& mesh_file) {
  return mesh_file + ".landmarks.yaml";
}

bool applyMeshOverride(Scene& scene, const std::string& mesh_file) {
  if (!existsAsFile(mesh_file)) {
    throw Error(mesh_file + ": there is no such surface file; give the path of an OBJ, STL, PLY or glTF file");
  }
  Scene changed = scene;
  changed.geometry.kind = GeometryScene::Kind::Mesh;
  changed.geometry.file = mesh_file;
  const bool has_sidecar = std::filesystem::exists(sidecarOf(mesh_file));
  if (has_sidecar) {
    const YamlSource source = YamlSource::load(sidecarOf(mesh_file), YamlLimits{});
    readKeys(source, source.root(), kSidecarKeys, changed);
  }
  checkComplete(changed.geometry, mesh_file);
  scene = changed;
  return has_sidecar;
}

}  // namespace vibe
