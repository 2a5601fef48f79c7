#include <sstream>

#include "scene/scene_value.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"

namespace vibe {
namespace {

int depthOf(const std::string& section) {
  int depth = section.empty() ? 0 : 1;
  for (const char c : section) depth += c == '.' ? 1 : 0;
  return depth;
}

bool isWritten(const SchemaRow& row, Scene& full) {
  if (row.only_for && *row.only_for != full.geometry.kind) return false;
  return row.required || isGiven(row, full);
}

}  // namespace

std::string toYaml(const Scene& scene) {
  Scene full = completeScene(scene);  // rows access every section
  std::ostringstream out;
  for (const SchemaSection& section : sceneSections()) {
    if (!section.isPresent(scene)) continue;
    const std::string name = section.name;
    const bool only_mesh = name == "geometry.landmarks" && scene.geometry.kind != GeometryScene::Kind::Mesh;
    if (only_mesh) continue;
    const int depth = depthOf(name);
    if (depth > 0) out << std::string(2 * (depth - 1), ' ') << lastPart(name) << ":\n";
    for (const SchemaRow& row : sceneSchema()) {
      if (sectionOf(row.key) != name || !isWritten(row, full)) continue;
      out << std::string(2 * depth, ' ') << lastPart(row.key) << ": " << valueText(row, full) << "\n";
    }
  }
  return out.str();
}

}  // namespace vibe
