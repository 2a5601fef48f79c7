#include "geometry/mesh_header.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr std::size_t kLongestHeader = 1 << 16;  // bytes

[[noreturn]] void reject(const std::string& path, const std::string& what) {
  throw Error("geometry.file: " + path + " is damaged: " + what + "; export it again");
}

std::string beginning(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text(kLongestHeader, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::uint32_t number(const std::string& bytes, std::size_t place) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof value);  // little endian, like the supported processors
  return value;
}

bool isPlyType(const std::string& word) {
  static const std::array<const char*, 16> known{"char",  "uchar",  "short",   "ushort", "int",   "uint",
                                                 "float", "double", "int8",    "uint8",  "int16", "uint16",
                                                 "int32", "uint32", "float32", "float64"};
  return std::find(known.begin(), known.end(), word) != known.end();
}

bool isPlyLine(const std::string& line, std::uintmax_t size) {
  std::istringstream words(line);
  std::string key, a, b, c, d;
  words >> key;
  if (key == "comment" || key == "obj_info") return true;
  words >> a >> b;
  if (key == "format") return (a == "ascii" || a == "binary_little_endian" || a == "binary_big_endian") && b == "1.0";
  if (key == "element") {
    const bool digits = !b.empty() && b.size() < 12 && b.find_first_not_of("0123456789") == std::string::npos;
    return digits && std::stoull(b) <= size;  // every element takes at least a byte
  }
  if (key != "property") return false;
  if (a != "list") return isPlyType(a) && !b.empty();
  words >> c >> d;
  return isPlyType(b) && isPlyType(c) && !d.empty();
}

void checkPly(const std::string& path, const std::string& text, std::uintmax_t size) {
  std::istringstream in(text);
  std::string line;
  for (int number_of_line = 1; std::getline(in, line); ++number_of_line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number_of_line == 1 ? line == "ply" : isPlyLine(line, size)) continue;
    if (line == "end_header" && number_of_line > 1) return;
    reject(path, "line " + std::to_string(number_of_line) + " of its header is not understood");
  }
  reject(path, "its header does not end");
}

void checkGlb(const std::string& path, const std::string& text, std::uintmax_t size) {
  if (text.size() < 20 || text.compare(0, 4, "glTF") != 0) reject(path, "it does not begin like a GLB file");
  if (number(text, 8) != size) {
    reject(path, "it states " + std::to_string(number(text, 8)) + " bytes but has " + std::to_string(size));
  }
  if (number(text, 12) > size - 20) reject(path, "its first part is longer than the file");
}

void checkStl(const std::string& path, const std::string& text, std::uintmax_t size) {
  const std::uintmax_t stated = text.size() >= 84 ? 84 + 50 * static_cast<std::uintmax_t>(number(text, 80)) : 0;
  if (stated == size || text.compare(0, 5, "solid") == 0) return;
  reject(path, stated == 0 ? "it is too short"
                           : "its triangles would take " + std::to_string(stated) + " bytes but it has " +
                                 std::to_string(size));
}

}  // namespace

void checkMeshHeader(const std::string& path, const std::string& type) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) reject(path, "its size cannot be found");
  const std::string text = beginning(path);
  if (type == ".ply") checkPly(path, text, size);
  if (type == ".glb") checkGlb(path, text, size);
  if (type == ".stl") checkStl(path, text, size);
}

}  // namespace vibe
