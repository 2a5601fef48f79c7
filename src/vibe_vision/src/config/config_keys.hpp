#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::vision {

/// A key of a map, for both ways: how it is read, and what is written of it. Tables of keys refer to the numbers that
/// they are about.
struct ConfigKey {
  std::string name;
  std::function<void(const YamlSource&, const YamlField&)> read;
  std::string text = "";    ///< of its value as YAML; empty: it is not written
  bool required = false;    ///< to be read
  std::string remark = "";  ///< a line that is written above it
};
using ConfigKeys = std::vector<ConfigKey>;

inline ConfigKey required(ConfigKey key) {
  key.required = true;
  return key;
}

/// Reads a map in the order of the file. @return its fields
/// @throws Error "file:line: key: what is wrong; remedy", also for a key that is not in the table, or missing
inline std::vector<YamlField> readMap(const YamlSource& source, const YamlField& field, const ConfigKeys& keys) {
  std::vector<std::string> known, required;
  for (const ConfigKey& key : keys) {
    known.push_back(key.name);
    if (key.required) required.push_back(key.name);
  }
  std::vector<YamlField> fields = source.map(field, known, required);
  for (const YamlField& entry : fields)
    keys[static_cast<std::size_t>(std::find(known.begin(), known.end(), entry.key) - known.begin())].read(source,
                                                                                                          entry);
  return fields;
}

/// The lines of a map, each behind a line break.
inline std::string blockText(const ConfigKeys& keys, const std::string& indent) {
  std::string text;
  for (const ConfigKey& key : keys) {
    if (key.text.empty()) continue;
    if (!key.remark.empty()) text += "\n" + indent + "# " + key.remark;
    text += "\n" + indent + key.name + (key.text[0] == '\n' ? ":" : ": ") + key.text;
  }
  return text;
}

template <class Numbers>
std::string listText(const Numbers& numbers, const std::string& unit) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + showQuantity(number, unit);
  return "[" + text + "]";
}

/// A map in one line.
inline ConfigKey mapKey(const std::string& name, const ConfigKeys& keys) {
  std::string text;
  for (const ConfigKey& key : keys) text += (text.empty() ? "" : ", ") + key.name + ": " + key.text;
  return {name, [keys](const auto& source, const auto& field) { readMap(source, field, keys); }, "{" + text + "}"};
}

/// A map in lines of its own.
inline ConfigKey blockKey(const std::string& name, const ConfigKeys& keys, const std::string& indent) {
  return {name, [keys](const auto& source, const auto& field) { readMap(source, field, keys); },
          blockText(keys, indent)};
}

/// A number from low to high.
inline ConfigKey numberKey(const std::string& name, double& value, const std::string& unit, double low, double high) {
  const auto read = [&value, unit, low, high](const YamlSource& source, const YamlField& field) {
    value = source.quantity(field, unit, low, high);
  };
  return {name, read, showQuantity(value, unit)};
}

/// A list of two numbers.
inline ConfigKey pairKey(const std::string& name, double& a, double& b, const std::string& unit, double low,
                         double high) {
  const auto read = [&a, &b, unit, low, high](const YamlSource& source, const YamlField& field) {
    const std::vector<double> values = source.quantities(field, 2, unit, low, high);
    a = values[0], b = values[1];
  };
  return {name, read, listText(std::vector<double>{a, b}, unit)};
}

}  // namespace vibe::vision
