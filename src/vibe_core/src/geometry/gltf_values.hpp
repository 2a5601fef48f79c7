#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace vibe {

// Values of a glTF file and how they are stored. `where` names the place in the file. All throw Error, as a clause that
// follows the name of the file.

using Json = nlohmann::json;

/// Throws what is wrong with the file, with a remedy.
[[noreturn]] void failGltf(const std::string& what);

/// A whole number from 0. @param otherwise  if the key is absent; below 0: then it throws
std::uint64_t wholeOf(const Json& object, const char* key, const std::string& where, std::int64_t otherwise = -1);
/// Empty if the key is absent.
std::string textOf(const Json& object, const char* key);
const Json& objectOf(const Json& object, const char* key, std::string_view where);
/// A list, or an empty one.
const Json& listIn(const Json& object, const char* key);
/// Exactly so many numbers, or nothing if the key is absent.
std::vector<double> numbersIn(const Json& object, const char* key, std::size_t count, const std::string& where);

struct GltfComponent {
  std::size_t size;  ///< [byte]
  double scale;      ///< of a normalised value: it stands for 1
  double (*read)(const char* bytes);
};

/// By its number in the standard.
GltfComponent gltfComponent(std::uint64_t type, const std::string& where);

std::string decodeBase64(std::string_view text, const std::string& where);
/// "my%20file.bin" -> "my file.bin"
std::string decodePercent(std::string_view uri);

/// JSON and binary part of a file, within its content.
struct GltfParts {
  std::string_view json, binary;
  bool has_binary = false;
};

/// @param content  of a GLB; outlives the parts
GltfParts partsOfGlb(const std::string& content);

}  // namespace vibe
