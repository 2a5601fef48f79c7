#pragma once
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vibe {

/// What a user file may cost. A file beyond is refused before it is parsed.
struct YamlLimits {
  std::size_t bytes = 1 << 20;  ///< size of the file
  int depth = 32;               ///< of nested maps and lists; yaml-cpp parses recursively
};

/// A key of a map (or an item of a list) with its value and its place.
struct YamlField {
  std::string key;   ///< last part only: "reach"
  std::string path;  ///< for people: "helix.reach"
  int line = 0;      ///< of the key, from 1
  YAML::Node value;  ///< refers to the document, which it keeps alive

  // Assigning a YAML::Node changes the document that it points into, so fields are only ever copied.
  YamlField(const YamlField&) = default;
  YamlField& operator=(const YamlField&) = delete;
};

/// One YAML document written by a user, and typed access to it in which every mistake ends in a vibe::Error
/// "file:line: key: what is wrong; remedy". Anchors, aliases and merge keys (<<) work.
class YamlSource {
 public:
  /// @throws Error if the file is missing, unreadable, something else in its place (a Git LFS pointer, a web page), too
  ///         large or as parse()
  static YamlSource load(const std::string& file, const YamlLimits& limits);
  /// @param place  what to call the text in errors, e.g. the file name
  /// @throws Error for text that is not exactly one YAML document with a map at the top, or beyond the limits
  static YamlSource parse(const std::string& text, const std::string& place, const YamlLimits& limits);

  const std::string& place() const { return place_; }  ///< name of the text in errors, such as that of the file
  YamlField root() const;                              ///< the map at the top; without key and path

  /// Names a character of the line, too, that is not what it looks like.
  [[noreturn]] void fail(const YamlField& field, const std::string& what_and_remedy) const;

  /// Fields of a map in the order of the file, merge keys resolved; a null value is an empty map.
  /// @throws Error if it is no map or has a key twice
  std::vector<YamlField> map(const YamlField& field) const;
  /// The same of a map of which each key must be one of `known` and each of the `required` must be there.
  std::vector<YamlField> map(const YamlField& field, const std::vector<std::string>& known,
                             const std::vector<std::string>& required = {}) const;
  /// Items of a list; their path is "field[0]" and so on.
  std::vector<YamlField> list(const YamlField& field) const;

  bool boolean(const YamlField& field) const;  ///< true, True, false or False
  /// A whole number from low to high, both allowed; exact up to 2^53.
  std::int64_t integer(const YamlField& field, std::int64_t low, std::int64_t high) const;
  /// A number in SI, or one with a unit of the same dimension; low and high in SI, both allowed.
  double quantity(const YamlField& field, const std::string& si_unit, double low, double high) const;
  /// Three of them, each within the range.
  std::vector<double> quantities(const YamlField& field, std::size_t count, const std::string& si_unit, double low,
                                 double high) const;
  /// A scalar without control characters, not empty.
  std::string text(const YamlField& field) const;
  /// One of the words.
  std::string choice(const YamlField& field, const std::vector<std::string>& words) const;

 private:
  std::string place_;
  YAML::Node root_;
  std::map<int, std::string> odd_characters_;  // by line

  std::string scalar(const YamlField& field, const std::string& expected) const;
  void collect(const YamlField& field, int& merges, std::vector<YamlField>& fields) const;
  void merge(const YamlField& field, const YAML::Node& sources, int& merges, std::vector<YamlField>& fields) const;
};

/// "1.5 Pa" or "3": a number as short as it can be read, with its unit unless it is a pure number.
std::string showQuantity(double value, const std::string& si_unit);

}  // namespace vibe
