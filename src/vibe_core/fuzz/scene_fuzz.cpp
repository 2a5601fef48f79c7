// sources: src/scene/[!m]*.cpp src/files/files.cpp src/geometry/stomach_knots.cpp src/program/plugins.cpp
// sources: src/geometry/surface_mesh.cpp src/files/foreign_content.cpp src/arithmetic/elementary_*.cpp
// sources: src/files/number_text.cpp
// packages: yaml-cpp
// corpus: scenes
#include <cstdlib>
#include <string>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"

// Any text as a scene: an Error with its sentence, or a scene that is written and read back to the same text.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  std::string written;
  try {
    written = vibe::toYaml(vibe::parseScene(text, "fuzz.yaml"));
  } catch (const vibe::Error& error) {
    require(error.what()[0] != '\0');
    return 0;
  }
  require(vibe::toYaml(vibe::parseScene(written, "written.yaml")) == written);
  return 0;
}
