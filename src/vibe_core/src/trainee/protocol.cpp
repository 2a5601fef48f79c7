#include "vibe_core/trainee/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scene/yaml_guard.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_core/trainee/suture_pattern.hpp"

namespace vibe {

namespace {

constexpr YamlLimits kLimits{16u << 20, 32};  // as of trainee scripts
constexpr std::size_t kMaxGoals = 10000;
constexpr int kMaxSets = 64, kMaxMarks = 64;
constexpr double kLongestPattern = 0.3;  // along or around the organ: beyond any stomach [m]
constexpr double kLongestTime = 3600;    // of one goal [s]

std::string at(const Place& place) {
  return formatted(" at %.0f %% of the %s, %.0f deg", 100 * place.along,
                   place.region ? toString(*place.region) : "axis", place.around * 180 / M_PI);
}

struct Describer {
  std::string operator()(const InsufflateGoal&) const { return "insufflate"; }
  std::string operator()(const InspectGoal& goal) const { return "inspect" + at(goal.place); }
  std::string operator()(const SurveyGoal& goal) const {
    return formatted("inspect %.0f %% of the %s", 100 * goal.coverage, goal.region ? toString(*goal.region) : "wall");
  }
  std::string operator()(const MarkGoal& goal) const { return "mark" + at(goal.place); }
  std::string operator()(const BiteGoal& goal) const { return "bite" + at(goal.place); }
  std::string operator()(const SutureSetGoal& goal) const {
    return "suture set '" + std::string(toString(goal.pattern)) + "' of " + std::to_string(goal.bites) + " bites" +
           at(goal.centre);
  }
  std::string operator()(const CinchGoal&) const { return "T-tag and cinch"; }
  std::string operator()(const WithdrawGoal&) const { return "withdraw"; }
  std::string operator()(const WaitGoal&) const { return "wait"; }
};

/// A row of goals along the organ.
struct Row {
  int count = 6;
  double from = 0.66, to = 0.31;  // along the axis; distal first, as in practice

  double step() const { return count > 1 ? (to - from) / (count - 1) : 0; }
  double along(int k) const { return count > 1 ? from + (to - from) * k / (count - 1) : from; }
};

/// A key of a map and where its value goes.
struct Key {
  std::string name;
  std::function<void(const YamlField&)> read;
};
using Keys = std::vector<Key>;

Keys operator+(Keys first, const Keys& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Converts the YAML of a protocol. Format: docs/protocols.md.
class ProtocolReader {
 public:
  explicit ProtocolReader(const YamlSource& source) : source_(source) {}

  /// @throws Error "file:line: key: what is wrong; remedy"
  Protocol read() {
    static const std::vector<std::string> keys{"name", "skill", "seed", "goals"};
    for (const YamlField& field : source_.map(source_.root())) {
      if (field.key == "name") {
        protocol_.name = source_.text(field);
      } else if (field.key == "seed") {
        protocol_.seed = static_cast<std::uint64_t>(source_.integer(field, 0, 9007199254740991));
      } else if (field.key == "skill") {
        protocol_.skill = field.value.IsMap() ? mixedSkill(field) : namedSkill(field);
      } else if (field.key == "goals") {
        readGoals(field);
      } else if (field.key == "actions") {
        source_.fail(field, "belongs to a script of motions, but its goals make this a protocol; keep one of the two");
      } else {
        source_.fail(field, "is not a known key; " + suggestKey(field.key, keys));
      }
    }
    if (protocol_.goals.empty()) source_.fail(source_.root(), "has no goals; write a list 'goals:'");
    if (protocol_.name.empty()) source_.fail(source_.root(), "has no name; write 'name: ...'");
    return protocol_;
  }

 private:
  const YamlSource& source_;
  Protocol protocol_;

  Key number(const char* name, const char* unit, double low, double high, double& value) const {
    return {name, [=, &value](const YamlField& field) { value = source_.quantity(field, unit, low, high); }};
  }
  Key count(const char* name, int low, int high, int& value) const {
    return {name, [=, &value](const YamlField& field) { value = static_cast<int>(source_.integer(field, low, high)); }};
  }
  Key flag(const char* name, bool& value) const {
    return {name, [this, &value](const YamlField& field) { value = source_.boolean(field); }};
  }
  /// One of the words of an enumeration from `first` to before `end`.
  template <class Enum, class Value>
  Key word(const char* name, int first, int end, Value& value) const {
    return {name, [=, &value](const YamlField& field) {
              std::vector<std::string> words;
              for (int k = first; k < end; ++k) words.emplace_back(toString(static_cast<Enum>(k)));
              const std::string chosen = source_.choice(field, words);
              value = static_cast<Enum>(first + (std::find(words.begin(), words.end(), chosen) - words.begin()));
            }};
  }
  Key region(std::optional<Region>& value) const { return word<Region>("region", 0, kRegionCount, value); }

  Keys placeNumbers(Place& place) const {
    return {number("along", "1", 0, 1, place.along), number("around", "rad", -M_PI, M_PI, place.around),
            number("distal", "m", -kLongestPattern, kLongestPattern, place.distal),
            number("anterior", "m", -kLongestPattern, kLongestPattern, place.anterior)};
  }
  /// Those of a place and more.
  Keys placeKeys(Place& place, const Keys& more = {}) const {
    return placeNumbers(place) + more + Keys{region(place.region)};
  }

  void readGoals(const YamlField& field) {
    for (const YamlField& item : source_.list(field)) {
      if (item.value.IsScalar()) {  // a goal without options: "- insufflate"
        readGoal({source_.text(item), item.path, item.line, YAML::Node()});
        continue;
      }
      const std::vector<YamlField> fields = source_.map(item);
      if (fields.empty()) source_.fail(item, "is empty; write a goal such as 'insufflate'");
      if (fields.size() > 1) source_.fail(fields[1], "is a second goal in one item; begin a new line with '- '");
      readGoal(fields.front());
    }
    if (protocol_.goals.size() > kMaxGoals) source_.fail(field, "has more than 10000 goals; split the protocol");
  }

  void readGoal(const YamlField& verb) {
    InsufflateGoal insufflate;
    MarkGoal mark;
    BiteGoal bite;
    WithdrawGoal withdraw;
    CinchGoal cinch;
    WaitGoal wait;
    const auto add = [&](const auto& goal, const Keys& keys) {
      return [&goal, &verb, keys, this] {
        readMap(verb, keys);
        protocol_.goals.emplace_back(goal);
      };
    };
    const std::vector<std::pair<std::string, std::function<void()>>> goals{
        {"insufflate", add(insufflate, {number("patience", "s", 1, kLongestTime, insufflate.patience)})},
        {"inspect", [&] { readInspect(verb); }},
        {"mark", add(mark, placeKeys(mark.place, {number("for", "s", 0.1, kLongestTime, mark.time)}))},
        {"marks", [&] { readMarks(verb); }},
        {"bite", add(bite, placeKeys(bite.place))},
        {"suture_set", [&] { readSleeve(verb); }},
        {"sleeve", [&] { readSleeve(verb); }},
        {"cinch", add(cinch, {})},
        {"withdraw", add(withdraw, {number("insertion", "m", 0, 1, withdraw.insertion)})},
        {"wait", add(wait, {number("for", "s", 0, kLongestTime, wait.time)})}};
    std::vector<std::string> names;
    for (const auto& [name, read] : goals) {
      if (name == verb.key) return read();
      names.push_back(name);
    }
    source_.fail(verb, "'" + printable(verb.key, 40) + "' is not a goal; " + suggestKey(verb.key, names));
  }

  // A place, or as much of the wall as `coverage` says.
  void readInspect(const YamlField& field) {
    InspectGoal place;
    SurveyGoal survey;
    if (!field.value.IsMap() || !field.value["coverage"]) {
      readMap(field, placeKeys(place.place, {number("distance", "m", 5e-3, 0.2, place.distance),
                                             number("for", "s", 0, kLongestTime, place.time)}));
      protocol_.goals.emplace_back(place);
      return;
    }
    readMap(field, {number("coverage", "1", 0, 1, survey.coverage), region(survey.region),
                    number("distance", "m", 5e-3, 0.2, survey.distance),
                    number("patience", "s", 1, kLongestTime, survey.patience)});
    protocol_.goals.emplace_back(survey);
  }

  // One set, or a row of them.
  void readSleeve(const YamlField& field) {
    Row row;
    SutureSetGoal set;
    const bool alone = field.key == "suture_set";
    const Keys sleeve{number("from", "1", 0, 1, row.from), number("to", "1", 0, 1, row.to),
                      number("around", "rad", -M_PI, M_PI, set.centre.around)};
    readMap(field, Keys{number("length", "m", 1e-3, kLongestPattern, set.length),
                        number("width", "m", 1e-3, kLongestPattern, set.width)} +
                       (alone ? placeNumbers(set.centre) : sleeve) +
                       Keys{count("bites", 2, kTechniqueMaxBites, set.bites)} +
                       (alone ? Keys{} : Keys{count("sets", 1, kMaxSets, row.count)}) +
                       Keys{flag("mirrored", set.mirrored), flag("cinched", set.cinched),
                            word<Technique>("pattern", 1, kTechniqueCount, set.pattern), region(set.centre.region)});
    checkPattern(field, set);
    if (alone) {
      protocol_.goals.emplace_back(set);
      return;
    }
    set.spacing = std::abs(row.step());
    for (int k = 0; k < row.count; ++k) {
      set.centre.along = row.along(k);
      protocol_.goals.emplace_back(set);
    }
  }

  // A row of marks along the organ.
  void readMarks(const YamlField& field) {
    Row row;
    row.count = 4;
    MarkGoal mark;
    readMap(field,
            {number("from", "1", 0, 1, row.from), number("to", "1", 0, 1, row.to),
             number("around", "rad", -M_PI, M_PI, mark.place.around), number("for", "s", 0.1, kLongestTime, mark.time),
             count("count", 1, kMaxMarks, row.count), region(mark.place.region)});
    for (int k = 0; k < row.count; ++k) {
      mark.place.along = row.along(k);
      protocol_.goals.emplace_back(mark);
    }
  }

  void checkPattern(const YamlField& field, const SutureSetGoal& goal) const {
    try {
      suturePattern(goal.pattern, goal.bites, goal.length, goal.width);
    } catch (const Error& error) {
      source_.fail(field, error.what());
    }
  }

  void readMap(const YamlField& field, const Keys& keys) const {
    for (const YamlField& entry : source_.map(field)) readKey(entry, keys, "'" + field.key + "' has none");
  }

  /// @param without  continues the error where there are no keys
  void readKey(const YamlField& field, const Keys& keys, const std::string& without = "") const {
    std::vector<std::string> known;
    for (const Key& key : keys) {
      if (field.key == key.name) return key.read(field);
      known.push_back(key.name);
    }
    source_.fail(field, "is not a known key; " + (known.empty() ? without : suggestKey(field.key, known)));
  }

  Skill namedSkill(const YamlField& field) const {
    return source_.choice(field, {"expert", "novice"}) == "novice" ? Skill::novice() : Skill::expert();
  }

  // A map of values that differ from those of an expert, a novice, or one in between.
  Skill mixedSkill(const YamlField& field) const {
    Skill skill;
    double novice = 0;
    bool begun = false;
    const std::vector<YamlField> entries = source_.map(field);
    for (const YamlField& entry : entries) {
      if (entry.key != "like" && entry.key != "novice") continue;
      if (begun)
        source_.fail(entry, "stands beside like or novice, and both say with what to begin; write one of them");
      begun = true;
      if (entry.key == "like") skill = namedSkill(entry);
      if (entry.key == "novice") novice = source_.quantity(entry, "1", 0, 1);
    }
    if (novice > 0) skill = between(Skill::expert(), Skill::novice(), novice);
    const auto begun_with = [](const YamlField&) {};
    const Keys keys{{"like", begun_with},
                    count("attempts", 1, 20, skill.attempts),
                    flag("checks_depth", skill.checks_depth),
                    {"novice", begun_with},
                    number("pace", "1", 0.05, 5, skill.pace),
                    number("reaction_time", "s", 0, 2, skill.reaction_time),
                    number("look_time", "s", 0, 600, skill.look_time),
                    number("foresight", "1", 0, 1, skill.foresight),
                    number("aim_error", "m", 0, 0.05, skill.aim_error),
                    number("force_limit", "N", 0.1, 100, skill.force_limit),
                    number("turns", "1", 0, 10, skill.turns),
                    number("drawn", "m", 0, 0.03, skill.drawn),
                    number("tightness", "1", 0, 1, skill.tightness),
                    number("tremor", "1", 0, 10, skill.tremor.scale)};
    for (const YamlField& entry : entries) readKey(entry, keys);
    return skill;
  }
};

}  // namespace

std::string describe(const Goal& goal) {
  return std::visit(Describer{}, goal);
}

Protocol Protocol::load(const std::string& file) {
  return ProtocolReader(YamlSource::load(file, kLimits)).read();
}

Protocol Protocol::parse(const std::string& yaml, const std::string& place) {
  return ProtocolReader(YamlSource::parse(yaml, place, kLimits)).read();
}

bool isProtocol(const std::string& file) {
  const YamlSource source = YamlSource::load(file, kLimits);
  const std::vector<YamlField> fields = source.map(source.root());
  return std::any_of(fields.begin(), fields.end(), [](const YamlField& field) { return field.key == "goals"; });
}

}  // namespace vibe
