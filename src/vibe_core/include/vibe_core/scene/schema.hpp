#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// Where the value of a key is stored in a Scene whose optional parts are present. The type of the reference is the
/// type of the key, so that the table cannot disagree with the struct.
using SceneAccess = std::variant<std::string& (*)(Scene&), bool& (*)(Scene&), int& (*)(Scene&),
                                 std::uint64_t& (*)(Scene&), double& (*)(Scene&), Eigen::Vector3d& (*)(Scene&),
                                 std::array<double, 3>& (*)(Scene&), std::vector<double>& (*)(Scene&),
                                 std::optional<Eigen::Vector3d>& (*)(Scene&), GeometryScene::Kind& (*)(Scene&)>;

/// One key of a scene file. This table drives parsing, range checks, error texts, writing and the documentation.
struct SchemaRow {
  const char* key;     ///< path, e.g. "gas.flow_limit"
  SceneAccess access;  ///< also gives the type, and the default: what a fresh Scene holds there
  const char* unit;    ///< SI unit of a number, "1" for a pure number, "" where the type has none
  double low;          ///< smallest allowed value (of each component) in `unit`; unused for texts and flags
  double high;         ///< largest allowed value, in `unit`
  const char* help;    ///< one sentence
  const char* source;  ///< where the default comes from
  /// The geometry.kind the key belongs to; empty: every one.
  std::optional<GeometryScene::Kind> only_for = std::nullopt;
  /// Shown instead of the struct's value if that stands for "absent"; the key is then left out when written.
  const char* absent = nullptr;
  bool required = false;  ///< in its section (and for its geometry.kind)
  /// The words that a text may be, in the order of the documentation; empty: see wordsOf().
  std::vector<std::string> words = {};
};

/// The words that the text of a row may be: its own, or the open list of choicesOf(). Empty: any text.
std::vector<std::string> wordsOf(const SchemaRow& row);

/// A part of a scene file that holds keys.
struct SchemaSection {
  const char* name;                 ///< path, e.g. "scope.base"
  const char* help;                 ///< one sentence
  void (*enter)(Scene&);            ///< makes the part present, with its defaults
  bool (*isPresent)(const Scene&);  ///< whether the scene has it
  void (*leave)(Scene&) = nullptr;  ///< takes the part away; null: every scene has it
  /// The section without which this one is an error, with why; null: none.
  const char* needs = nullptr;
  /// Why, as a relative clause about that section: "whose tool carries the helix"; null without `needs`.
  const char* needs_why = nullptr;
};

/// All keys in the order of the documentation.
const std::vector<SchemaRow>& sceneSchema();

/// All sections; a section comes before the sections inside it. The top level is the one without a name.
const std::vector<SchemaSection>& sceneSections();

/// The row of a full key, or null if there is none.
const SchemaRow* findRow(const std::string& key);
/// The section of that name, or null if there is none.
const SchemaSection* findSection(const std::string& name);

/// The scene with every optional part present, with its defaults where it was absent: what rows are read from and
/// written to.
Scene completeScene(const Scene& scene = {});

/// The words of geometry.kind, in the order of the enum.
const std::array<const char*, 3>& geometryKindNames();
const char* toString(GeometryScene::Kind kind);

/// The section a key belongs to: "gas.flow_limit" -> "gas", "name" -> "".
std::string sectionOf(const std::string& key);
/// The last part of a key: "gas.flow_limit" -> "flow_limit".
std::string lastPart(const std::string& key);

/// The default of a row as people read it, e.g. "1333 Pa".
std::string defaultText(const SchemaRow& row);

/// The whole table as Markdown, section by section: the reference part of docs/scenes.md.
std::string describeSchema();

}  // namespace vibe
