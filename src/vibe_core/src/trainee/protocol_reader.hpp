#pragma once
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_core/trainee/protocol.hpp"

namespace vibe {

/// Converts the YAML of a protocol. Format: docs/protocols.md.
class ProtocolReader {
 public:
  explicit ProtocolReader(const YamlSource& source) : source_(source) {}

  /// @throws Error "file:line: key: what is wrong; remedy"
  Protocol read();

 private:
  /// A key with a number.
  struct Number {
    const char* key;
    const char* unit;
    double low, high;
    double* value;
  };
  /// A key with a whole number.
  struct Count {
    const char* key;
    int low, high;
    int* value;
  };
  /// A key with yes or no.
  struct Flag {
    const char* key;
    bool* value;
  };
  /// All keys of a map.
  struct Keys {
    std::vector<Number> numbers;
    std::vector<Count> counts;
    std::vector<Flag> flags;
    Technique* pattern = nullptr;
    std::optional<Region>* region = nullptr;
  };

  const YamlSource& source_;
  Protocol protocol_;

  void readGoals(const YamlField& field);
  void readGoal(const YamlField& verb);
  void readSleeve(const YamlField& field);
  void readMarks(const YamlField& field);
  Skill readSkill(const YamlField& field) const;
  Skill namedSkill(const YamlField& field) const;
  Skill mixedSkill(const YamlField& field) const;
  void readMap(const YamlField& field, const Keys& keys) const;
  bool readKey(const YamlField& field, const Keys& keys) const;
  Technique readPattern(const YamlField& field) const;
  Region readRegion(const YamlField& field) const;
  void checkPattern(const YamlField& field, const SutureSetGoal& goal) const;
  static std::vector<Number> placeKeys(Place& place);
  static Keys keysOf(Place& place);
};

}  // namespace vibe
