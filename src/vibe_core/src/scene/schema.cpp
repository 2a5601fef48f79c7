#include "vibe_core/scene/schema.hpp"

#include <sstream>

#include "scene/scene_keys.hpp"
#include "vibe_core/scene/words.hpp"
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
  if (std::holds_alternative<std::vector<double>& (*)(Scene&)>(row.access)) return "list of " + unit;
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
  if (!full.tissue.relaxation) full.tissue.relaxation.emplace();
  if (!full.gas) full.gas.emplace();
  if (!full.gravity) full.gravity.emplace();
  if (!full.foundation) full.foundation.emplace();
  if (!full.breathing) full.breathing.emplace();
  if (!full.motion) full.motion.emplace();
  if (!full.scope) full.scope.emplace();
  if (!full.scope->compliance) full.scope->compliance.emplace();
  if (!full.helix) full.helix.emplace();
  if (!full.suture) full.suture.emplace();
  if (!full.bleeding) full.bleeding.emplace();
  if (!full.marking) full.marking.emplace();
  if (!full.inspection) full.inspection.emplace();
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

namespace {

/// A section that a scene may lack.
template <auto kMember>
SchemaSection optionalSection(const char* name, const char* help, const char* needs = nullptr,
                              const char* needs_why = nullptr) {
  return {name,
          help,
          [](Scene& s) { (s.*kMember).emplace(); },
          [](const Scene& s) { return (s.*kMember).has_value(); },
          [](Scene& s) { (s.*kMember).reset(); },
          needs,
          needs_why};
}

}  // namespace

const std::vector<SchemaSection>& sceneSections() {
  static const auto nothing = [](Scene&) {};
  static const auto always = [](const Scene&) { return true; };
  static const std::vector<SchemaSection> sections = {
      {"", "The top level.", nothing, always},
      {"geometry", "Shape and resolution of the organ.", nothing, always},
      {"geometry.landmarks", "The four points from which regions and walls of an imported surface are found.", nothing,
       [](const Scene& s) { return s.geometry.oesophagus.has_value(); }},
      {"tissue", "The wall.", nothing, always},
      {"tissue.thickness", "Thickness of the wall by region.", nothing, always},
      {"tissue.stiffness", "Stiffness of the wall by region, of model shell.", nothing, always},
      {"tissue.fibres",
       "Fibres in the wall, of model shell (Holzapfel, Gasser, Ogden 2000). Without this section there are none.",
       [](Scene& s) { s.tissue.fibres.emplace(); }, [](const Scene& s) { return s.tissue.fibres.has_value(); },
       [](Scene& s) { s.tissue.fibres.reset(); }},
      {"tissue.relaxation",
       "Stress that relaxes while the strain stays, of model shell: quasi-linear viscoelasticity (Fung) with a Prony "
       "series, see [Computation](computation.md#relaxation). The law is then that of fast strains. Without this "
       "section the wall is elastic.",
       [](Scene& s) { s.tissue.relaxation.emplace(); }, [](const Scene& s) { return s.tissue.relaxation.has_value(); },
       [](Scene& s) { s.tissue.relaxation.reset(); }},
      {"attachments", "Ends that are fixed. Without any the organ is free.", nothing, always},
      optionalSection<&Scene::gas>(
          "gas", "Gas in the lumen, and an insufflator. Without this section there is no pressure in the lumen."),
      optionalSection<&Scene::gravity>("gravity", "Weight of the wall."),
      optionalSection<&Scene::foundation>(
          "foundation", "Neighbouring organs, modelled as springs from every particle to its position at rest."),
      optionalSection<&Scene::breathing>(
          "breathing",
          "The diaphragm moves the foundation and the attached end of the oesophagus towards the feet (-z) and back, "
          "by amplitude (1 - cos(2 pi rate t)) / 2; the duodenum and the hand that holds the scope stay. Of model "
          "shell; needs `foundation`. Without this section nothing breathes, unless `motion` is there.",
          "foundation", "which the diaphragm moves"),
      optionalSection<&Scene::motion>(
          "motion",
          "What moves a living stomach by itself ([motion.md](motion.md)): contraction waves, respiration, the heart. "
          "Respiration is that of a healthy adult, or what `breathing` says. Of model shell, of a stomach; needs "
          "`foundation`. Without this section only `breathing` moves the organ.",
          "foundation", "which respiration and heart move"),
      optionalSection<&Scene::scope>("scope", "The endoscope with its suturing device."),
      {"scope.base", "Pose of the root link. Without this section the scope enters at the oesophagus.",
       [](Scene& s) { s.scope->base_from_anatomy = false; },
       [](const Scene& s) { return s.scope.has_value() && !s.scope->base_from_anatomy; },
       [](Scene& s) { s.scope->base_from_anatomy = true; }},
      {"scope.compliance",
       "Bending section and shaft give way under load, so that the tip is not where the hand commands it. Without this "
       "section the scope is rigid.",
       [](Scene& s) { s.scope->compliance.emplace(); },
       [](const Scene& s) { return s.scope.has_value() && s.scope->compliance.has_value(); },
       [](Scene& s) { s.scope->compliance.reset(); }},
      optionalSection<&Scene::helix>("helix", "Tissue helix of the suturing device; needs `scope`.", "scope",
                                     "whose tool carries the helix"),
      optionalSection<&Scene::suture>(
          "suture",
          "Needle, thread, T-tag and cinch of the suturing device; needs `helix`. Without this section "
          "the needle takes no bites.",
          "helix", "which brings the wall to the needle"),
      optionalSection<&Scene::bleeding>(
          "bleeding",
          "Bleeding after a bite, random from the seed; needs `suture`. Without this section no bite bleeds.", "suture",
          "whose bites bleed"),
      optionalSection<&Scene::marking>(
          "marking",
          "Argon plasma coagulation from a probe in the scope: marks and burns ([marking.md](marking.md)); needs "
          "`scope`. Without this section the pedal has no effect.",
          "scope", "whose tip carries the probe"),
      optionalSection<&Scene::inspection>(
          "inspection",
          "What of the inside of the wall counts as seen ([coverage](metrics.md#coverage)): it is measured in scenes "
          "with this section, and changes nothing else; needs `scope`.",
          "scope", "whose lens sees the wall"),
  };
  return sections;
}

}  // namespace vibe
