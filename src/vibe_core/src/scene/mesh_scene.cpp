#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "arithmetic/turn.hpp"
#include "geometry/regions.hpp"
#include "geometry/remesh.hpp"
#include "geometry/surface_check.hpp"
#include "scene/scene_keys.hpp"
#include "scene/size_estimate.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_core/scene/words.hpp"
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
    std::error_code ignored;
    const bool exists = std::filesystem::exists(mesh_file, ignored);
    throw Error(mesh_file + (exists ? ": is not a file" : ": there is no such surface file") +
                "; give the path of an OBJ, STL, PLY or glTF file");
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

namespace {

constexpr int kGuessVertices = 1500;  // fine enough for landmarks to a few millimetres

struct Guess {
  SizeEstimate size;  // of confidence 1 if the unit is stated
  LandmarkEstimate landmarks;
};

std::string doubtsAbout(const Guess& guess, const std::string& mesh_file) {
  std::string doubts;
  if (guess.size.confidence < kSureLandmarks)
    doubts += "\nThe unit of " + mesh_file + " is doubtful: taken as " + guess.size.unit.name + ", " +
              guess.size.doubt + "; state unit or target_volume in " + sidecarOf(mesh_file) + ".";
  if (guess.landmarks.confidence < kSureLandmarks)
    doubts += "\nThe landmarks of " + mesh_file + " are doubtful: " + guess.landmarks.doubt +
              "; state them, or its axes as rotation_rpy, in " + sidecarOf(mesh_file) + ".";
  return doubts;
}

std::string describe(const GeometryScene& g, const Guess& guess, const std::string& mesh_file) {
  const auto point = [](const Eigen::Vector3d& p) { return formatted("[%.4g, %.4g, %.4g]", p.x(), p.y(), p.z()); };
  const std::string head = formatted("unit: %g\nrotation_rpy: [%.6f, %.6f, %.6f]\nlandmarks:\n", g.unit,
                                     g.rotation_rpy[0], g.rotation_rpy[1], g.rotation_rpy[2]);
  const auto& moved = guess.landmarks.spread;
  const std::string sureness =
      formatted("\n# confidence %.2f of 1; axes tilted by 20 degrees move them by up to %.0f, %.0f, %.0f and %.0f mm",
                *g.landmark_confidence, 1e3 * moved[0], 1e3 * moved[1], 1e3 * moved[2], 1e3 * moved[3]);
  return "Unit, axes and landmarks of " + mesh_file + " are guesses; look at the regions, and state them in " +
         sidecarOf(mesh_file) + ":\n" + head + "  oesophagus: " + point(*g.oesophagus) +
         "\n  fundus: " + point(*g.fundus) + "\n  incisura: " + point(*g.incisura) +
         "\n  pylorus: " + point(*g.pylorus) + sureness + doubtsAbout(guess, mesh_file);
}

/// Those that the format or the file states, else those of medical images.
std::array<double, 3> guessedRotation(const std::string& mesh_file) {
  if (statesMetres(mesh_file)) return {M_PI / 2, 0, M_PI / 2};
  return rotationOf(statedAxes(mesh_file).value_or(PatientAxes::Lps));
}

/// @throws Error that names the file and says where to state the landmarks
LandmarkEstimate landmarksOf(const SurfaceMesh& surface, const std::string& mesh_file) {
  try {
    return estimateLandmarks(remeshSurface(surface, kGuessVertices, nullptr, {}));
  } catch (const Error& error) {
    throw Error(mesh_file + ": " + error.what() + " State them, or its axes as rotation_rpy, in " +
                sidecarOf(mesh_file) + ".");
  }
}

Guess guess(GeometryScene& geometry, double thickness) {
  SurfaceMesh surface = readMeshFile(geometry.file);
  checkSurface(surface, geometry.file);
  orientOutwards(surface);
  Guess result{{{}, 1, ""}, {}};
  const bool unit_is_stated = geometry.unit != 0;
  if (!unit_is_stated) result.size = estimateUnit(surface, thickness);
  if (!unit_is_stated) geometry.unit = result.size.unit.metres;
  if (geometry.rotation_rpy == std::array<double, 3>{0, 0, 0}) geometry.rotation_rpy = guessedRotation(geometry.file);
  const Eigen::Matrix3d map = geometry.unit * rotationFromRpy(geometry.rotation_rpy);
  for (auto& v : surface.vertices) v = map * v;
  result.landmarks = landmarksOf(surface, geometry.file);
  if (!unit_is_stated) addLengthMark(result.landmarks.length, result.size);
  const Landmarks& found = result.landmarks.landmarks;
  const Eigen::Matrix3d back = map.inverse();
  geometry.oesophagus = back * found.oesophagus;
  geometry.fundus = back * found.fundus;
  geometry.incisura = back * found.incisura;
  geometry.pylorus = back * found.pylorus;
  geometry.landmark_confidence = std::min(result.size.confidence, result.landmarks.confidence);
  return result;
}

}  // namespace

std::string useMesh(Scene& scene, const std::string& mesh_file) {
  const GeometryScene& g = scene.geometry;
  const bool stated = g.oesophagus || g.fundus || g.incisura || g.pylorus;
  if (stated || std::filesystem::exists(sidecarOf(mesh_file)) || !std::filesystem::is_regular_file(mesh_file)) {
    applyMeshOverride(scene, mesh_file);
    return "";
  }
  GeometryScene changed = g;
  changed.kind = GeometryScene::Kind::Mesh;
  changed.file = mesh_file;
  const auto& walls = scene.tissue.thickness;
  const double thickness = std::accumulate(walls.begin(), walls.end(), 0.0) / static_cast<double>(walls.size());
  const Guess guessed = guess(changed, thickness);
  scene.geometry = changed;
  return describe(changed, guessed, mesh_file);
}

std::string landmarkRemark(const Scene& scene) {
  if (!scene.geometry.landmark_confidence) return "";
  return formatted("landmarks          guessed, confidence %.2f\n", *scene.geometry.landmark_confidence);
}

}  // namespace vibe
