#include "vibe_core/scene/schema.hpp"

#include <sstream>

#include "scene/scene_value.hpp"
#include "vibe_core/scene/choices.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {
namespace {

std::string wordList(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

std::string rangeText(const SchemaRow& row) {
  if (std::holds_alternative<GeometryScene::Kind& (*)(Scene&)>(row.access)) return "stomach, mesh, sphere";
  if (std::holds_alternative<bool& (*)(Scene&)>(row.access)) return "true, false";
  std::vector<std::string> words = wordsOf(row);
  for (const Choice& choice : choicesNotLoaded(row.key)) words.push_back(choice.word);
  if (!words.empty()) return wordList(words);
  if (std::holds_alternative<std::string& (*)(Scene&)>(row.access)) return "text";
  return showQuantity(row.low, "") + " to " + showQuantity(row.high, "");
}

std::string unitText(const SchemaRow& row) {
  const bool three = std::holds_alternative<Eigen::Vector3d& (*)(Scene&)>(row.access) ||
                     std::holds_alternative<std::array<double, 3>& (*)(Scene&)>(row.access) ||
                     std::holds_alternative<std::optional<Eigen::Vector3d>& (*)(Scene&)>(row.access);
  const std::string unit = row.unit;
  if (unit.empty() || unit == "1") return unit;
  return three ? "3 x " + unit : unit;
}

/// A table of the words of a key with an open list.
void describeChoices(const SchemaRow& row, std::ostream& out) {
  const std::vector<Choice> choices = choicesOf(row.key);
  if (choices.empty()) return;
  out << "| `" << row.key << "` | meaning |\n|---|---|\n";
  for (const Choice& choice : choices) out << "| `" << choice.word << "` | " << choice.meaning << " |\n";
  for (const Choice& choice : choicesNotLoaded(row.key))
    out << "| `" << choice.word << "` | " << choice.meaning << "; needs the package `" << choice.package << "` |\n";
  out << "\n";
}

void describeSection(const SchemaSection& section, std::ostream& out) {
  const std::string name = section.name;
  out << "### " << (name.empty() ? "Top level" : "`" + name + "`") << "\n\n" << section.help << "\n\n";
  out << "| key | unit | default | range | meaning | source of the default |\n|---|---|---|---|---|---|\n";
  for (const SchemaRow& row : sceneSchema()) {
    if (sectionOf(row.key) != name) continue;
    const std::string only = row.only_for ? std::string(" (kind `") + toString(*row.only_for) + "` only)" : "";
    out << "| `" << lastPart(row.key) << "` | " << unitText(row) << " | "
        << (row.required ? "required" : defaultText(row)) << " | " << rangeText(row) << " | " << row.help << only
        << " | " << row.source << " |\n";
  }
  out << "\n";
  for (const SchemaRow& row : sceneSchema()) {
    if (sectionOf(row.key) == name) describeChoices(row, out);
  }
}

}  // namespace

std::vector<std::string> wordsOf(const SchemaRow& row) {
  std::vector<std::string> words = row.words;
  for (const Choice& choice : choicesOf(row.key)) words.push_back(choice.word);
  return words;
}

const SchemaRow* findRow(const std::string& key) {
  for (const SchemaRow& row : sceneSchema()) {
    if (key == row.key) return &row;
  }
  return nullptr;
}

const SchemaSection* findSection(const std::string& name) {
  for (const SchemaSection& section : sceneSections()) {
    if (name == section.name) return &section;
  }
  return nullptr;
}

Scene completeScene(const Scene& scene) {
  Scene full = scene;
  if (!full.tissue.fibres) full.tissue.fibres.emplace();
  if (!full.gas) full.gas.emplace();
  if (!full.gravity) full.gravity.emplace();
  if (!full.foundation) full.foundation.emplace();
  if (!full.scope) full.scope.emplace();
  if (!full.scope->compliance) full.scope->compliance.emplace();
  if (!full.helix) full.helix.emplace();
  if (!full.suture) full.suture.emplace();
  if (!full.bleeding) full.bleeding.emplace();
  if (!full.marking) full.marking.emplace();
  return full;
}

const std::array<const char*, 3>& geometryKindNames() {
  static const std::array<const char*, 3> names{"stomach", "mesh", "sphere"};
  return names;
}

const char* toString(GeometryScene::Kind kind) {
  return geometryKindNames().at(static_cast<std::size_t>(kind));
}

std::string sectionOf(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::string lastPart(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? key : key.substr(dot + 1);
}

std::string defaultText(const SchemaRow& row) {
  if (row.absent != nullptr) return row.absent;
  Scene scene = completeScene();
  return valueText(row, scene);
}

std::string describeSchema() {
  std::ostringstream out;
  for (const SchemaSection& section : sceneSections()) describeSection(section, out);
  return out.str();
}

}  // namespace vibe
