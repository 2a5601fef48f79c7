#include "geometry/gltf_values.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "geometry/text_lines.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

struct ComponentRow {
  std::uint64_t type;  // in the standard
  GltfComponent component;
};

constexpr std::array<ComponentRow, 6> kComponents{{{5120, {1, 127, littleEndian<std::int8_t>}},
                                                   {5121, {1, 255, littleEndian<std::uint8_t>}},
                                                   {5122, {2, 32767, littleEndian<std::int16_t>}},
                                                   {5123, {2, 65535, littleEndian<std::uint16_t>}},
                                                   {5125, {4, 4294967295.0, littleEndian<std::uint32_t>}},
                                                   {5126, {4, 1, littleEndian<float>}}}};

std::uint32_t gltfWord(const std::string& content, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, content.data() + at, sizeof value);
  return value;
}

}  // namespace

void failGltf(const std::string& what) {
  throw Error(what + "; correct the file, or write it anew");
}

std::uint64_t wholeOf(const Json& object, const char* key, const std::string& where, std::int64_t otherwise) {
  const auto found = object.find(key);
  if (found == object.end() && otherwise >= 0) return static_cast<std::uint64_t>(otherwise);
  if (found == object.end()) failGltf(where + " has no '" + key + "'");
  if (found->is_number_unsigned()) return found->get<std::uint64_t>();
  if (found->is_number_float() && found->get<double>() >= 0 && found->get<double>() < 1e15 &&
      found->get<double>() == std::floor(found->get<double>()))
    return static_cast<std::uint64_t>(found->get<double>());
  failGltf("'" + std::string(key) + "' of " + where + " is not a whole number from 0");
}

std::string textOf(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

const Json& objectOf(const Json& object, const char* key, std::string_view where) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_object()) failGltf(std::string(where) + " has no '" + key + "'");
  return *found;
}

const Json& listIn(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

std::vector<double> numbersIn(const Json& object, const char* key, std::size_t count, const std::string& where) {
  const auto found = object.find(key);
  std::vector<double> numbers;
  if (found == object.end()) return numbers;
  for (const Json& value : listIn(object, key))
    if (value.is_number()) numbers.push_back(value.get<double>());
  if (numbers.size() != count)
    failGltf("'" + std::string(key) + "' of " + where + " is not a list of " + std::to_string(count) + " numbers");
  return numbers;
}

GltfComponent gltfComponent(std::uint64_t type, const std::string& where) {
  for (const ComponentRow& row : kComponents)
    if (row.type == type) return row.component;
  failGltf(where + " has the componentType " + std::to_string(type) + ", which glTF 2.0 does not have");
}

std::string decodeBase64(std::string_view text, const std::string& where) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t k = 0; k < kDigits.size(); ++k) value[static_cast<unsigned char>(kDigits[k])] = static_cast<int>(k);
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0) failGltf("the data URI of " + where + " is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

std::string decodePercent(std::string_view uri) {
  const auto digit = [](char c) {
    const std::size_t at = std::string_view("0123456789abcdefABCDEF").find(c);
    return at == std::string_view::npos ? -1 : static_cast<int>(at < 16 ? at : at - 6);
  };
  std::string text;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    const bool escaped = uri[k] == '%' && k + 2 < uri.size() && digit(uri[k + 1]) >= 0 && digit(uri[k + 2]) >= 0;
    text += escaped ? static_cast<char>(digit(uri[k + 1]) * 16 + digit(uri[k + 2])) : uri[k];
    if (escaped) k += 2;
  }
  return text;
}

GltfParts partsOfGlb(const std::string& content) {
  if (content.size() < 20) throw Error("ends within the header of GLB; it may have been cut off");
  if (gltfWord(content, 4) != 2)
    throw Error("is GLB of version " + std::to_string(gltfWord(content, 4)) +
                ", which is not supported; export it as glTF 2.0");
  if (gltfWord(content, 8) != content.size())
    throw Error("states " + std::to_string(gltfWord(content, 8)) + " bytes but has " + std::to_string(content.size()) +
                "; it may have been cut off or changed while it was written or copied");
  GltfParts parts;
  for (std::size_t at = 12; at < content.size();) {
    const std::size_t left = content.size() - at;
    if (left < 8 || gltfWord(content, at) > left - 8)
      failGltf("its part at byte " + std::to_string(at) + " is longer than the file");
    const std::uint32_t size = gltfWord(content, at), type = gltfWord(content, at + 4);
    const std::string_view part = std::string_view(content).substr(at + 8, size);
    if (at == 12 && type != 0x4e4f534a) failGltf("its first part is not JSON");
    if (at == 12) parts.json = part;
    if (at > 12 && type == 0x004e4942 && !parts.has_binary) parts.binary = part, parts.has_binary = true;
    at += 8 + size;
  }
  return parts;
}

}  // namespace vibe
