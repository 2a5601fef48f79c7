#include "trainee/protocol_reader.hpp"

#include <algorithm>
#include <cmath>

#include "scene/yaml_guard.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/trainee/suture_pattern.hpp"

namespace vibe {
namespace {

constexpr int kMaxGoals = 10000;
constexpr int kMaxSets = 64, kMaxMarks = 64;
constexpr double kLongestPattern = 0.3;  // along or around the organ: beyond any stomach [m]
constexpr double kLongestTime = 3600;    // of one goal [s]

const std::vector<std::string>& goalNames() {
  static const std::vector<std::string> names{"insufflate", "inspect", "mark",  "marks",    "bite",
                                              "suture_set", "sleeve",  "cinch", "withdraw", "wait"};
  return names;
}

/// A row of goals along the organ.
struct Row {
  int count = 6;
  double from = 0.66, to = 0.31;  // along the axis; distal first, as in practice

  double step() const { return count > 1 ? (to - from) / (count - 1) : 0; }
  double along(int k) const { return count > 1 ? from + (to - from) * k / (count - 1) : from; }
};

}  // namespace

Protocol ProtocolReader::read() {
  static const std::vector<std::string> keys{"name", "skill", "seed", "goals"};
  for (const YamlField& field : source_.map(source_.root())) {
    if (field.key == "name") {
      protocol_.name = source_.text(field);
    } else if (field.key == "seed") {
      protocol_.seed = static_cast<std::uint64_t>(source_.integer(field, 0, 9007199254740991));
    } else if (field.key == "skill") {
      protocol_.skill = readSkill(field);
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

void ProtocolReader::readGoals(const YamlField& field) {
  for (const YamlField& item : source_.list(field)) {
    if (item.value.IsScalar()) {  // a goal without options: "- insufflate"
      YamlField verb{source_.text(item), item.path, item.line, YAML::Node()};
      readGoal(verb);
      continue;
    }
    const std::vector<YamlField> fields = source_.map(item);
    if (fields.empty()) source_.fail(item, "is empty; write a goal such as 'insufflate'");
    if (fields.size() > 1) source_.fail(fields[1], "is a second goal in one item; begin a new line with '- '");
    readGoal(fields.front());
  }
  if (protocol_.goals.size() > kMaxGoals) source_.fail(field, "has more than 10000 goals; split the protocol");
}

std::vector<ProtocolReader::Number> ProtocolReader::placeKeys(Place& place) {
  return {{"along", "1", 0, 1, &place.along},
          {"around", "rad", -M_PI, M_PI, &place.around},
          {"distal", "m", -kLongestPattern, kLongestPattern, &place.distal},
          {"anterior", "m", -kLongestPattern, kLongestPattern, &place.anterior}};
}

ProtocolReader::Keys ProtocolReader::keysOf(Place& place) {
  Keys keys;
  keys.numbers = placeKeys(place);
  keys.region = &place.region;
  return keys;
}

void ProtocolReader::readGoal(const YamlField& verb) {
  if (verb.key == "insufflate") {
    InsufflateGoal goal;
    readMap(verb, {{{"patience", "s", 1, kLongestTime, &goal.patience}}, {}, {}});
    protocol_.goals.emplace_back(goal);
  } else if (verb.key == "inspect") {
    InspectGoal goal;
    Keys keys = keysOf(goal.place);
    keys.numbers.push_back({"distance", "m", 5e-3, 0.2, &goal.distance});
    keys.numbers.push_back({"for", "s", 0, kLongestTime, &goal.time});
    readMap(verb, keys);
    protocol_.goals.emplace_back(goal);
  } else if (verb.key == "marks") {
    readMarks(verb);
  } else if (verb.key == "mark") {
    MarkGoal goal;
    Keys keys = keysOf(goal.place);
    keys.numbers.push_back({"for", "s", 0.1, kLongestTime, &goal.time});
    readMap(verb, keys);
    protocol_.goals.emplace_back(goal);
  } else if (verb.key == "bite") {
    BiteGoal goal;
    readMap(verb, keysOf(goal.place));
    protocol_.goals.emplace_back(goal);
  } else if (verb.key == "cinch") {
    readMap(verb, {});
    protocol_.goals.emplace_back(CinchGoal{});
  } else if (verb.key == "withdraw") {
    WithdrawGoal goal;
    readMap(verb, {{{"insertion", "m", 0, 1, &goal.insertion}}, {}, {}});
    protocol_.goals.emplace_back(goal);
  } else if (verb.key == "wait") {
    WaitGoal goal;
    readMap(verb, {{{"for", "s", 0, kLongestTime, &goal.time}}, {}, {}});
    protocol_.goals.emplace_back(goal);
  } else if (verb.key == "suture_set" || verb.key == "sleeve") {
    readSleeve(verb);
  } else {
    source_.fail(verb, "'" + printable(verb.key, 40) + "' is not a goal; " + suggestKey(verb.key, goalNames()));
  }
}

// One set, or a row of them.
void ProtocolReader::readSleeve(const YamlField& field) {
  Row row;
  SutureSetGoal set;
  Keys keys;
  keys.pattern = &set.pattern;
  keys.region = &set.centre.region;
  keys.counts = {{"bites", 2, kTechniqueMaxBites, &set.bites}};
  keys.flags = {{"mirrored", &set.mirrored}, {"cinched", &set.cinched}};
  keys.numbers = {{"length", "m", 1e-3, kLongestPattern, &set.length},
                  {"width", "m", 1e-3, kLongestPattern, &set.width}};
  if (field.key == "suture_set") {
    for (const Number& key : placeKeys(set.centre)) keys.numbers.push_back(key);
  } else {
    keys.counts.push_back({"sets", 1, kMaxSets, &row.count});
    keys.numbers.push_back({"from", "1", 0, 1, &row.from});
    keys.numbers.push_back({"to", "1", 0, 1, &row.to});
    keys.numbers.push_back({"around", "rad", -M_PI, M_PI, &set.centre.around});
  }
  readMap(field, keys);
  checkPattern(field, set);
  if (field.key == "suture_set") {
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
void ProtocolReader::readMarks(const YamlField& field) {
  Row row;
  row.count = 4;
  MarkGoal mark;
  Keys keys;
  keys.region = &mark.place.region;
  keys.counts = {{"count", 1, kMaxMarks, &row.count}};
  keys.numbers = {{"from", "1", 0, 1, &row.from},
                  {"to", "1", 0, 1, &row.to},
                  {"around", "rad", -M_PI, M_PI, &mark.place.around},
                  {"for", "s", 0.1, kLongestTime, &mark.time}};
  readMap(field, keys);
  for (int k = 0; k < row.count; ++k) {
    mark.place.along = row.along(k);
    protocol_.goals.emplace_back(mark);
  }
}

void ProtocolReader::checkPattern(const YamlField& field, const SutureSetGoal& goal) const {
  try {
    suturePattern(goal.pattern, goal.bites, goal.length, goal.width);
  } catch (const Error& error) {
    source_.fail(field, error.what());
  }
}

void ProtocolReader::readMap(const YamlField& field, const Keys& keys) const {
  for (const YamlField& entry : source_.map(field)) {
    if (readKey(entry, keys)) continue;
    std::vector<std::string> known;
    for (const Number& key : keys.numbers) known.emplace_back(key.key);
    for (const Count& key : keys.counts) known.emplace_back(key.key);
    for (const Flag& key : keys.flags) known.emplace_back(key.key);
    if (keys.pattern != nullptr) known.emplace_back("pattern");
    if (keys.region != nullptr) known.emplace_back("region");
    source_.fail(entry, known.empty() ? "is not a known key; '" + field.key + "' has none"
                                      : "is not a known key; " + suggestKey(entry.key, known));
  }
}

bool ProtocolReader::readKey(const YamlField& field, const Keys& keys) const {
  for (const Number& key : keys.numbers)
    if (field.key == key.key) return *key.value = source_.quantity(field, key.unit, key.low, key.high), true;
  for (const Count& key : keys.counts)
    if (field.key == key.key) return *key.value = static_cast<int>(source_.integer(field, key.low, key.high)), true;
  for (const Flag& key : keys.flags)
    if (field.key == key.key) return *key.value = source_.boolean(field), true;
  if (keys.region != nullptr && field.key == "region") return *keys.region = readRegion(field), true;
  if (keys.pattern == nullptr || field.key != "pattern") return false;
  *keys.pattern = readPattern(field);
  return true;
}

Region ProtocolReader::readRegion(const YamlField& field) const {
  std::vector<std::string> words;
  for (int r = 0; r < kRegionCount; ++r) words.emplace_back(toString(static_cast<Region>(r)));
  const std::string word = source_.choice(field, words);
  return static_cast<Region>(std::find(words.begin(), words.end(), word) - words.begin());
}

Technique ProtocolReader::readPattern(const YamlField& field) const {
  std::vector<std::string> words;
  for (int t = 1; t < kTechniqueCount; ++t) words.emplace_back(toString(static_cast<Technique>(t)));
  const std::string word = source_.choice(field, words);
  return static_cast<Technique>(1 + (std::find(words.begin(), words.end(), word) - words.begin()));
}

Skill ProtocolReader::namedSkill(const YamlField& field) const {
  return source_.choice(field, {"expert", "novice"}) == "novice" ? Skill::novice() : Skill::expert();
}

// expert, novice, or a map of values that differ from one of them.
Skill ProtocolReader::readSkill(const YamlField& field) const {
  return field.value.IsMap() ? mixedSkill(field) : namedSkill(field);
}

Skill ProtocolReader::mixedSkill(const YamlField& field) const {
  Skill skill;
  double novice = 0;
  bool begun = false;
  const std::vector<YamlField> entries = source_.map(field);
  for (const YamlField& entry : entries) {
    if (entry.key != "like" && entry.key != "novice") continue;
    if (begun) source_.fail(entry, "stands beside like or novice, and both say with what to begin; write one of them");
    begun = true;
    if (entry.key == "like") skill = namedSkill(entry);
    if (entry.key == "novice") novice = source_.quantity(entry, "1", 0, 1);
  }
  if (novice > 0) skill = between(Skill::expert(), Skill::novice(), novice);
  Keys keys;
  keys.numbers = {{"novice", "1", 0, 1, &novice},
                  {"pace", "1", 0.05, 5, &skill.pace},
                  {"reaction_time", "s", 0, 2, &skill.reaction_time},
                  {"look_time", "s", 0, 600, &skill.look_time},
                  {"foresight", "1", 0, 1, &skill.foresight},
                  {"aim_error", "m", 0, 0.05, &skill.aim_error},
                  {"force_limit", "N", 0.1, 100, &skill.force_limit},
                  {"turns", "1", 0, 10, &skill.turns},
                  {"drawn", "m", 0, 0.03, &skill.drawn},
                  {"tightness", "1", 0, 1, &skill.tightness},
                  {"tremor", "1", 0, 10, &skill.tremor.scale}};
  keys.counts = {{"attempts", 1, 20, &skill.attempts}};
  keys.flags = {{"checks_depth", &skill.checks_depth}};
  for (const YamlField& entry : entries) {
    if (entry.key == "like" || readKey(entry, keys)) continue;
    std::vector<std::string> known{"like", "attempts", "checks_depth"};
    for (const Number& key : keys.numbers) known.emplace_back(key.key);
    source_.fail(entry, "is not a known key; " + suggestKey(entry.key, known));
  }
  return skill;
}

}  // namespace vibe
