// sources: src/geometry/*_reader.cpp src/geometry/polygon.cpp src/geometry/text_lines.cpp
// sources: src/geometry/gltf_values.cpp src/files/number_text.cpp
// sources: src/geometry/surface_check.cpp src/geometry/triangle_tree.cpp src/geometry/surface_mesh.cpp
// sources: src/files/foreign_content.cpp src/arithmetic/elementary_*.cpp
// includes: ../vibe_firmware/fuzz
#include <string>

#include "fuzz_input.hpp"
#include "geometry/mesh_readers.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/files/foreign_content.hpp"
#include "vibe_core/program/error.hpp"

// Any bytes as a file of each of the four formats: an Error with its reason, or triangles whose corners exist. A glTF
// finds every file that it names, with the same bytes. The corpus are the files of test/reports.

namespace {

using namespace vibe;
using vibe_firmware::require;

template <class Reader>
void read(const Reader& reader) {
  try {
    const SurfaceMesh mesh = reader();
    const auto count = static_cast<int>(mesh.vertices.size());
    for (const auto& t : mesh.triangles)
      for (const int v : t) require(v >= 0 && v < count);
    if (mesh.triangles.size() < 200) checkSurface(mesh, "fuzz");
  } catch (const Error& error) {
    require(error.what()[0] != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(data, data + size);
  foreignContent(content);
  read([&] { return readObj(content); });
  read([&] { return readStl(content); });
  read([&] { return readPly(content); });
  read([&] { return readGltf(content, [&](const std::string&) { return content; }); });
  return 0;
}
