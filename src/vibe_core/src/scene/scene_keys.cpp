#include "scene/scene_keys.hpp"

#include "vibe_core/scene/words.hpp"

namespace vibe {

const std::vector<RenamedKey>& renamedKeys() {
  static const std::vector<RenamedKey> keys = {
      {"bed", "foundation"},
      {"tissue.damping_rate", "tissue.mass_damping"},
      {"tissue.damping_time", "tissue.stiffness_damping"},
      {"helix.prick_force", "helix.initial_hold_force"},
      {"suture.least_bites", "suture.min_bites"},
      {"suture.most_bites", "suture.max_bites"},
      {"suture.pulling", "suture.cinch_model"},
      {"suture.technique_rule", "suture.classifier"},
      {"skin", "render_surface"},
  };
  return keys;
}

const char* newNameOf(const std::string& key) {
  for (const RenamedKey& renamed : renamedKeys())
    if (key == renamed.old_key) return renamed.new_key;
  return nullptr;
}

namespace {

/// Lengths of an imported file are in the unit of that file, so no unit may be written.
std::string unitOf(const SchemaRow& row) {
  return std::string(row.unit) == "file units" ? "1" : row.unit;
}

Eigen::Vector3d readVector(const YamlSource& source, const YamlField& field, const SchemaRow& row) {
  const std::vector<double> values = source.quantities(field, 3, unitOf(row), row.low, row.high);
  return {values[0], values[1], values[2]};
}

/// Reads a value of each type that a row can have.
struct Reader {
  const YamlSource& source;
  const YamlField& field;
  const SchemaRow& row;
  Scene& scene;

  void operator()(std::string& (*at)(Scene&)) const {
    std::vector<std::string> words = wordsOf(row);
    if (words.empty()) {
      at(scene) = source.text(field);
      return;
    }
    const std::vector<Choice> others = choicesNotLoaded(row.key);
    for (const Choice& other : others) words.push_back(other.word);
    at(scene) = source.choice(field, words);
    for (const Choice& other : others)
      if (at(scene) == other.word) source.fail(field, sayNotLoaded(other));
  }
  void operator()(bool& (*at)(Scene&)) const { at(scene) = source.boolean(field); }
  void operator()(int& (*at)(Scene&)) const { at(scene) = static_cast<int>(integer()); }
  void operator()(std::uint64_t& (*at)(Scene&)) const { at(scene) = static_cast<std::uint64_t>(integer()); }
  void operator()(double& (*at)(Scene&)) const { at(scene) = source.quantity(field, row.unit, row.low, row.high); }
  void operator()(Eigen::Vector3d& (*at)(Scene&)) const { at(scene) = readVector(source, field, row); }
  void operator()(std::optional<Eigen::Vector3d>& (*at)(Scene&)) const { at(scene) = readVector(source, field, row); }
  void operator()(std::array<double, 3>& (*at)(Scene&)) const {
    const Eigen::Vector3d value = readVector(source, field, row);
    at(scene) = {value.x(), value.y(), value.z()};
  }
  void operator()(std::vector<double>& (*at)(Scene&)) const {
    at(scene).clear();
    for (const YamlField& item : source.list(field))
      at(scene).push_back(source.quantity(item, row.unit, row.low, row.high));
  }
  void operator()(GeometryScene::Kind& (*at)(Scene&)) const {
    const auto& names = geometryKindNames();
    const std::string word = source.choice(field, {names.begin(), names.end()});
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (word == names[k]) at(scene) = static_cast<GeometryScene::Kind>(k);
    }
  }

  std::int64_t integer() const {
    return source.integer(field, static_cast<std::int64_t>(row.low), static_cast<std::int64_t>(row.high));
  }
};

template <typename Vector>
std::string vectorText(const Vector& values) {
  std::string text = "[";  // by number: vectors of Eigen 3.3 have no iterators
  for (std::size_t k = 0; k < static_cast<std::size_t>(values.size()); ++k)
    text += (k > 0 ? ", " : "") + showQuantity(values[k], "");
  return text + "]";
}

/// In single quotes YAML keeps every printable text unchanged.
std::string quotedText(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

struct Writer {
  Scene& scene;

  std::string operator()(std::string& (*at)(Scene&)) const { return quotedText(at(scene)); }
  std::string operator()(bool& (*at)(Scene&)) const { return at(scene) ? "true" : "false"; }
  std::string operator()(int& (*at)(Scene&)) const { return std::to_string(at(scene)); }
  std::string operator()(std::uint64_t& (*at)(Scene&)) const { return std::to_string(at(scene)); }
  std::string operator()(double& (*at)(Scene&)) const { return showQuantity(at(scene), ""); }
  std::string operator()(Eigen::Vector3d& (*at)(Scene&)) const { return vectorText(at(scene)); }
  std::string operator()(std::array<double, 3>& (*at)(Scene&)) const { return vectorText(at(scene)); }
  std::string operator()(std::vector<double>& (*at)(Scene&)) const { return vectorText(at(scene)); }
  std::string operator()(std::optional<Eigen::Vector3d>& (*at)(Scene&)) const {
    return at(scene) ? vectorText(*at(scene)) : "";
  }
  std::string operator()(GeometryScene::Kind& (*at)(Scene&)) const { return toString(at(scene)); }
};

}  // namespace

void readValue(const YamlSource& source, const YamlField& field, const SchemaRow& row, Scene& scene) {
  std::visit(Reader{source, field, row, scene}, row.access);
}

std::string valueText(const SchemaRow& row, Scene& scene) {
  return std::visit(Writer{scene}, row.access);
}

bool isGiven(const SchemaRow& row, Scene& scene) {
  if (row.absent == nullptr) return true;
  Scene fresh = completeScene();
  return valueText(row, scene) != valueText(row, fresh);
}

}  // namespace vibe
