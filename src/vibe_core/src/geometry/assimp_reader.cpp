#include "geometry/assimp_reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "common/own_place.hpp"
#include "geometry/mesh_stream.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr char kProgram[] = "vibe_mesh_reader";
constexpr char kVariable[] = "VIBE_MESH_READER";

std::filesystem::path findReader() {
  if (const char* named = std::getenv(kVariable); named != nullptr && *named != '\0') return named;
  std::filesystem::path found = findOwnProgram(kProgram);
  if (!found.empty()) return found;
  throw Error(std::string("geometry.file: the program ") + kProgram +
              ", which reads meshes, is installed neither beside this program nor beside the library; set " +
              kVariable + " to its path.");
}

/// Larger files get more time and memory.
WorkLimits limitsFor(const std::string& path) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  const auto megabytes = none ? 0U : static_cast<unsigned>(size >> 20);
  WorkLimits limits;
  limits.seconds = 20 + megabytes / 2;
  limits.memory += std::size_t{100} * megabytes << 20;
  return limits;
}

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, ' ');
  return text;
}

}  // namespace

SurfaceMesh readWithAssimp(const std::string& path) {
  return readWithAssimp(path, limitsFor(path));
}

SurfaceMesh readWithAssimp(const std::string& path, const WorkLimits& limits) {
  const std::filesystem::path reader = findReader();
  // the time limit in the program itself applies only if this process ends first
  const std::string seconds = std::to_string(limits.seconds + 5), memory = std::to_string(limits.memory);
  try {
    return unpackMesh(runHelper(reader, {path, seconds, memory}, limits));
  } catch (const Error& e) {
    throw Error("geometry.file: " + path + " cannot be read (" + oneLine(e.what()) + "); export it again");
  }
}

}  // namespace vibe
