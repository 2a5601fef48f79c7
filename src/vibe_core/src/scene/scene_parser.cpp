#include "vibe_core/scene/scene_parser.hpp"

#include <filesystem>
#include <map>
#include <sstream>

#include "program/plugins.hpp"
#include "scene/scene_keys.hpp"
#include "scene/yaml_guard.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {

namespace {

constexpr const char* kBase = "base";     // the key of the scene file that another one starts from
constexpr const char* kWithout = "none";  // instead of a section: the scene lacks it, whatever its base has
constexpr int kMaxBases = 8;              // design choice: a chain of more is a circle

/// Keys and sections directly inside a section.
std::vector<std::string> keysIn(const std::string& section) {
  std::vector<std::string> keys;
  for (const SchemaRow& row : sceneSchema()) {
    if (sectionOf(row.key) == section) keys.push_back(lastPart(row.key));
  }
  for (const SchemaSection& inner : sceneSections()) {
    if (inner.name != section && *inner.name != '\0' && sectionOf(inner.name) == section) {
      keys.push_back(lastPart(inner.name));
    }
  }
  if (section.empty()) keys.emplace_back(kBase);
  return keys;
}

bool isPackagePath(const std::string& path) {
  return path.rfind("package://", 0) == 0;
}

Scene load(const std::string& file, int depth);

/// Reads one file into a Scene.
class SceneReader {
 public:
  /// @param depth  number of files that start from this one
  explicit SceneReader(const YamlSource& source, int depth = 0) : source_(source), depth_(depth) {}

  Scene read() {
    readBase();
    readSection(source_.root());
    checkApplies();
    checkRequired();
    checkNeeds();
    checkRelaxation();
    checkProcedure();
    scene_.file = source_.place();
    if (seen_.count("geometry.file") > 0) resolve(scene_.geometry.file);
    if (seen_.count("scope.urdf") > 0 && !isPackagePath(scene_.scope->urdf)) resolve(scene_.scope->urdf);
    return scene_;
  }

  /// @throws Error if a file that the scene names does not exist
  void checkFiles() const {
    const auto mesh = seen_.find("geometry.file");
    if (mesh != seen_.end()) checkFile(mesh->second, scene_.geometry.file);
    const auto urdf = seen_.find("scope.urdf");
    if (urdf != seen_.end() && !isPackagePath(scene_.scope->urdf)) checkFile(urdf->second, scene_.scope->urdf);
  }

 private:
  const YamlSource& source_;
  int depth_;
  Scene scene_;
  bool has_base_ = false;
  std::map<std::string, YamlField> seen_;
  std::map<std::string, YamlField> left_out_;  // sections that are taken away

  /// Starts from the scene that the file names, which is valid on its own.
  void readBase() {
    for (const YamlField& field : source_.map(source_.root())) {
      if (field.key != kBase) continue;
      std::string file = source_.text(field);
      if (isPackagePath(file)) {
        file = resolve(field, file);
      } else {
        resolve(file);
      }
      if (depth_ >= kMaxBases)
        source_.fail(field, "starts from a scene that starts from another, and so on more than " +
                                std::to_string(kMaxBases) +
                                " times, perhaps in a circle; name one that starts from fewer");
      checkFile(field, file);
      scene_ = load(file, depth_ + 1);
      has_base_ = true;
    }
  }

  void readSection(const YamlField& section) {
    seen_.emplace(section.path, section);
    const SchemaSection& known = *findSection(section.path);
    if (!has_base_ || !known.isPresent(scene_)) known.enter(scene_);
    for (const YamlField& field : source_.map(section)) {
      if (field.path == kBase) continue;
      checkDots(field);
      if (findSection(field.path) != nullptr && !field.path.empty()) {
        if (field.value.IsScalar() && field.value.Scalar() == kWithout)
          leaveOut(field);
        else
          readSection(field);
      } else if (const SchemaRow* row = findRow(field.path)) {
        readValue(source_, field, *row, scene_);
        seen_.emplace(field.path, field);
      } else {
        failUnknown(section.path, field);
      }
    }
  }

  void leaveOut(const YamlField& field) {
    const SchemaSection& known = *findSection(field.path);
    if (known.leave == nullptr) source_.fail(field, "is in every scene; write its keys, or leave it out");
    if (known.isPresent(scene_)) known.leave(scene_);
    left_out_.emplace(field.path, field);
  }

  /// `scope.friction: 0.1` would set a value in a section that is not there.
  void checkDots(const YamlField& field) const {
    const std::size_t dot = field.key.rfind('.');
    if (dot == std::string::npos) return;
    source_.fail(field, "has a dot in it; write '" + printable(field.key.substr(dot + 1), 40) + "' in the section '" +
                            printable(field.key.substr(0, dot), 40) + "'");
  }

  [[noreturn]] void failUnknown(const std::string& section, const YamlField& field) const {
    if (const char* name = newNameOf(field.path))
      source_.fail(field, "has a new name; write it as '" + std::string(name) + "'");
    const std::vector<std::string> here = keysIn(section);
    if (nearestKey(field.key, here).empty()) {
      for (const SchemaRow& row : sceneSchema()) {
        if (lastPart(row.key) != field.key) continue;
        source_.fail(field, "is not known here; write it as '" + std::string(row.key) + "'");
      }
    }
    source_.fail(field, "is not a known key; " + suggestKey(field.key, here));
  }

  void checkApplies() const {
    const GeometryScene::Kind kind = scene_.geometry.kind;
    const std::string has = std::string("does not apply to geometry.kind '") + toString(kind) + "'; ";
    const auto landmarks = seen_.find("geometry.landmarks");
    if (landmarks != seen_.end() && kind != GeometryScene::Kind::Mesh) {
      source_.fail(landmarks->second, has + "remove it or write 'kind: mesh'");
    }
    for (const SchemaRow& row : sceneSchema()) {
      const auto field = seen_.find(row.key);
      if (field == seen_.end() || !row.only_for || *row.only_for == kind) continue;
      source_.fail(field->second, has + "remove it or write 'kind: " + toString(*row.only_for) + "'");
    }
  }

  void checkRequired() const {
    for (const SchemaRow& row : sceneSchema()) {
      const bool applies = !row.only_for || *row.only_for == scene_.geometry.kind;
      const auto section = seen_.find(sectionOf(row.key));
      if (!row.required || !applies || section == seen_.end() || seen_.count(row.key) > 0) continue;
      Scene full = completeScene(scene_);
      if (has_base_ && isGiven(row, full)) continue;
      source_.fail(section->second, "lacks the key '" + lastPart(row.key) + "' (" + row.help + "); add it");
    }
  }

  void checkNeeds() const {
    for (const SchemaSection& section : sceneSections()) {
      if (section.needs == nullptr || !section.isPresent(scene_)) continue;
      const std::string needed = section.needs;
      if (findSection(needed)->isPresent(scene_)) continue;
      const auto without = left_out_.find(needed);
      if (without != left_out_.end())
        source_.fail(without->second, std::string("is what '") + section.name + "' needs, " + section.needs_why +
                                          "; add '" + section.name + ": none'");
      source_.fail(seen_.at(section.name),
                   "needs the section '" + needed + "', " + section.needs_why + "; add '" + needed + ": {}'");
    }
  }

  void checkRelaxation() const {
    if (!scene_.tissue.relaxation) return;
    const auto section = seen_.find("tissue.relaxation");
    const bool inherited = section == seen_.end();
    const YamlField& field = inherited ? seen_.at("") : section->second;
    const std::string subject = inherited ? "has tissue.relaxation from its base, which " : "";
    if (scene_.tissue.model != "shell")
      source_.fail(field, subject + "needs tissue.model 'shell', and the model is '" + scene_.tissue.model +
                              "'; write 'relaxation: none' or 'model: shell'");
    const std::string fault = relaxationFault(*scene_.tissue.relaxation, scene_.step_period);
    if (!fault.empty()) source_.fail(field, subject + fault);
  }

  /// Checks values against each other.
  void checkProcedure() const {
    if (const auto& suture = scene_.suture) {
      checkOrder("suture.min_bites", suture->min_bites, "suture.max_bites", suture->max_bites);
      checkOrder("suture.loose_tension", suture->loose_tension, "suture.cinch_tension", suture->cinch_tension);
      checkOrder("suture.cinch_tension", suture->cinch_tension, "suture.thread_strength", suture->thread_strength);
      if (suture->loose_tension == suture->cinch_tension) {
        source_.fail(written("suture.loose_tension", "suture.cinch_tension"),
                     "leaves every cinch loose; write a loose_tension below the cinch_tension");
      }
    }
    if (const auto& marking = scene_.marking) {
      checkOrder("marking.mark_energy", marking->apc.mark_energy, "marking.burn_energy", marking->apc.burn_energy);
      checkOrder("marking.burn_energy", marking->apc.burn_energy, "marking.deep_energy", marking->apc.deep_energy);
    }
    const auto& bleeding = scene_.bleeding;
    if (bleeding && bleeding->mild_probability + bleeding->brisk_probability > 1) {
      source_.fail(written("bleeding.mild_probability", "bleeding.brisk_probability"),
                   "is too much: mild_probability and brisk_probability together must be at most 1; lower one of them");
    }
  }

  /// Of two keys that contradict each other, the one that the user wrote; the other may be a default.
  const YamlField& written(const std::string& key, const std::string& other) const {
    const auto field = seen_.find(key);
    return field != seen_.end() ? field->second : seen_.at(other);
  }

  void checkOrder(const std::string& low, double low_value, const std::string& high, double high_value) const {
    if (low_value <= high_value) return;
    const std::string unit = findRow(low)->unit;
    const bool low_is_written = seen_.count(low) > 0;
    const std::string here = showQuantity(low_is_written ? low_value : high_value, unit);
    const std::string there = showQuantity(low_is_written ? high_value : low_value, unit);
    source_.fail(written(low, high), "is " + here + ", but " + (low_is_written ? high : low) + " is " + there +
                                         "; write at " + (low_is_written ? "most" : "least") + " that");
  }

  void resolve(std::string& path) const {
    if (path.empty() || std::filesystem::path(path).is_absolute()) return;
    path = (std::filesystem::path(source_.place()).parent_path() / path).lexically_normal().string();
  }

  std::string resolve(const YamlField& field, const std::string& address) const {
    try {
      return resolveAddress(address);
    } catch (const Error& error) {
      source_.fail(field, error.what());
    }
  }

  void checkFile(const YamlField& field, const std::string& path) const {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) return;
    const bool exists = std::filesystem::exists(path, ignored);
    source_.fail(field, (exists ? "'" + path + "' is not a file" : "there is no file '" + path + "'") +
                            "; give the path of a file, relative to the scene file");
  }
};

/// The default limits: a scene needs a few kilobytes, so they leave room for any comment.
constexpr YamlLimits kSceneLimits{};

}  // namespace

namespace {

Scene load(const std::string& file, int depth) {
  const YamlSource source = YamlSource::load(file, kSceneLimits);
  SceneReader reader(source, depth);
  Scene scene = reader.read();
  reader.checkFiles();
  // whoever builds the organ takes a relative path to lead from the scene file
  if (!scene.geometry.file.empty()) scene.geometry.file = std::filesystem::absolute(scene.geometry.file).string();
  return scene;
}

}  // namespace

Scene loadScene(const std::string& file) {
  loadPlugins();
  return load(file, 0);
}

Scene parseScene(const std::string& yaml, const std::string& place) {
  loadPlugins();
  const YamlSource source = YamlSource::parse(yaml, place, kSceneLimits);
  return SceneReader(source).read();
}

namespace {

int depthOf(const std::string& section) {
  int depth = section.empty() ? 0 : 1;
  for (const char c : section) depth += c == '.' ? 1 : 0;
  return depth;
}

bool isWritten(const SchemaRow& row, Scene& full) {
  if (row.only_for && *row.only_for != full.geometry.kind) return false;
  return row.required || isGiven(row, full);
}

}  // namespace

std::string toYaml(const Scene& scene) {
  Scene full = completeScene(scene);  // rows access every section
  std::ostringstream out;
  for (const SchemaSection& section : sceneSections()) {
    if (!section.isPresent(scene)) continue;
    const std::string name = section.name;
    const bool only_mesh = name == "geometry.landmarks" && scene.geometry.kind != GeometryScene::Kind::Mesh;
    if (only_mesh) continue;
    const int depth = depthOf(name);
    if (depth > 0) out << std::string(2 * (depth - 1), ' ') << lastPart(name) << ":\n";
    for (const SchemaRow& row : sceneSchema()) {
      if (sectionOf(row.key) != name || !isWritten(row, full)) continue;
      out << std::string(2 * depth, ' ') << lastPart(row.key) << ": " << valueText(row, full) << "\n";
    }
  }
  return out.str();
}

}  // namespace vibe
