#include <algorithm>
#include <cmath>

#include "scene/yaml_guard.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/input/joint_unit.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe {
namespace {

/// Room for the maximum number of actions.
constexpr YamlLimits kScriptLimits{16u << 20, 32};
constexpr int kMaxActions = 100000;
constexpr double kLongestScript = 86400;  // a day [s]
constexpr double kShortestMotion = 0.01;  // faster than any hand [s]
// A button must keep its state for the longest step that a scene allows, or the simulator could miss the press.
constexpr double kShortestPress = 0.1;  // [s]
// Times are sums of user input, so 0.1 s + 0.2 s is slightly more than 0.3 s.
constexpr double kRounding = 1e-9;  // [s]

/// A verb and the keys allowed with it.
struct Verb {
  const char* name;
  std::vector<std::string> options;
};

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all{
      {"move", {"in", "speed", "after"}},
      {"move_by", {"in", "speed", "after"}},
      {"hold", {"for", "after"}},
      {"press", {"after"}},
      {"release", {"after"}},
      {"wait", {}},
      {"phase", {}},
      {"together", {}},
  };
  return all;
}

std::vector<std::string> verbNames() {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) names.emplace_back(verb.name);
  return names;
}

const Verb* findVerb(const std::string& name) {
  for (const Verb& verb : verbs()) {
    if (name == verb.name) return &verb;
  }
  return nullptr;
}

/// Far beyond any device. The simulator clamps to the tool's own limits; this check only rejects unit errors.
double largestPosition(int joint) {
  return isPrismatic(joint) ? 1.0 : 100.0;
}
double largestTremor(int joint) {
  return isPrismatic(joint) ? 0.01 : 0.2;
}

template <typename Names>
int indexOf(const YamlSource& source, const YamlField& field, const std::string& word, const Names& names,
            const char* what) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (word == names[k]) return static_cast<int>(k);
  }
  source.fail(field,
              "'" + printable(word, 40) + "' is not a " + what + "; " + suggestKey(word, {names.begin(), names.end()}));
}

std::string seconds(double time) {
  return formatted("%.3f s", time);
}

}  // namespace

/// Converts the YAML of a trainee script into its timeline. Format: docs/trainee_scripts.md.
class ScriptReader {
 public:
  explicit ScriptReader(const YamlSource& source) : source_(source) {}

  /// @throws Error "file:line: key: what is wrong; remedy"
  TraineeScript read() {
    TremorSettings tremor;
    std::uint64_t seed = 1;
    const std::vector<YamlField> fields = source_.map(source_.root(), {"name", "seed", "start", "tremor", "actions"});
    for (const YamlField& field : fields) {
      if (field.key == "name") script_.name_ = source_.text(field);
      if (field.key == "seed") seed = static_cast<std::uint64_t>(source_.integer(field, 0, 9007199254740991));
      if (field.key == "tremor") tremor = readTremor(field);
      if (field.key == "start") readStart(field);
    }
    // In a second pass, because the actions need the start, which may stand anywhere in the file.
    for (const YamlField& field : fields) {
      if (field.key == "actions") readActions(field);
    }
    if (action_count_ == 0) source_.fail(source_.root(), "has no actions; write a list 'actions:'");
    if (script_.name_.empty()) source_.fail(source_.root(), "has no name; write 'name: ...'");
    script_.tremor_ = Tremor(tremor, seed);
    return script_;
  }

 private:
  /// One entry of the list of actions: its verb and the accompanying keys.
  struct Action {
    YamlField place;
    YamlField verb;
    std::vector<YamlField> options;
  };

  const YamlSource& source_;
  TraineeScript script_;
  double clock_ = 0;  // start time of the next action [s]
  int action_count_ = 0;

  void readStart(const YamlField& field) {
    for (const YamlField& entry : source_.map(field)) {
      const int joint = jointOf(entry);
      const double limit = largestPosition(joint);
      script_.timeline_.setStart(joint, source_.quantity(entry, jointUnit(joint), -limit, limit));
    }
  }

  TremorSettings readTremor(const YamlField& field) const {
    TremorSettings settings;
    for (const YamlField& entry : source_.map(field, {"frequency", "amplitude", "scale"})) {
      if (entry.key == "frequency") readTremorBand(entry, settings);
      if (entry.key == "scale") settings.scale = source_.quantity(entry, "1", 0, 10);
      if (entry.key != "amplitude") continue;
      for (const YamlField& one : source_.map(entry)) {
        const int joint = jointOf(one);
        settings.amplitude[joint] = source_.quantity(one, jointUnit(joint), 0, largestTremor(joint));
      }
    }
    return settings;
  }

  void readTremorBand(const YamlField& field, TremorSettings& settings) const {
    const std::vector<double> band = source_.quantities(field, 2, "1/s", 0.1, 30);
    if (band[0] > band[1]) source_.fail(field, "has its upper end first; write [low, high]");
    settings.low_frequency = band[0];
    settings.high_frequency = band[1];
  }

  void readActions(const YamlField& field) {
    for (const YamlField& item : source_.list(field)) {
      clock_ = play(readAction(item), clock_, false);
      script_.timeline_.extendTo(clock_);
    }
  }

  Action readAction(const YamlField& item) const {
    const std::vector<YamlField> fields = source_.map(item);
    const auto is_verb = [](const YamlField& field) { return findVerb(field.key) != nullptr; };
    const auto verb = std::find_if(fields.begin(), fields.end(), is_verb);
    if (verb == fields.end()) {
      if (fields.empty()) source_.fail(item, "is empty; write an action such as 'wait: 1 s'");
      source_.fail(fields.front(), "is not an action; " + suggestKey(fields.front().key, verbNames()));
    }
    std::vector<YamlField> options;
    for (const YamlField& field : fields) {
      if (field.key == verb->key) continue;
      if (is_verb(field)) source_.fail(field, "is a second action in one item; begin a new line with '- '");
      const std::vector<std::string>& allowed = findVerb(verb->key)->options;
      if (std::find(allowed.begin(), allowed.end(), field.key) == allowed.end()) {
        const std::string remedy = allowed.empty() ? "remove it" : suggestKey(field.key, allowed);
        source_.fail(field, "does not go with '" + verb->key + "'; " + remedy);
      }
      options.push_back(field);
    }
    return {item, *verb, options};
  }

  const YamlField* option(const Action& action, const char* key) const {
    for (const YamlField& field : action.options) {
      if (field.key == key) return &field;
    }
    return nullptr;
  }

  /// @return NaN if the option is absent
  double timeOption(const Action& action, const char* key, double low) const {
    const YamlField* field = option(action, key);
    return field == nullptr ? std::nan("") : source_.quantity(*field, "s", low, kLongestScript);
  }

  // This and the next three take the start time of the action and return its end time [s].
  double play(const Action& action, double begin, bool in_group) {
    const YamlField& verb = action.verb;
    if (++action_count_ > kMaxActions) source_.fail(action.place, "is one action too many; write at most 100000");
    if (in_group && (verb.key == "together" || verb.key == "wait" || verb.key == "phase")) {
      source_.fail(verb, "cannot stand inside 'together'; write it before, or delay actions there with 'after'");
    }
    const double delay = timeOption(action, "after", 0);
    if (delay > 0) begin += delay;
    double end = begin;
    if (verb.key == "move" || verb.key == "move_by") end = playMove(action, begin, verb.key == "move_by");
    if (verb.key == "hold") end = playHold(action, begin);
    if (verb.key == "press" || verb.key == "release") end = playEdge(action, begin, verb.key == "press");
    if (verb.key == "wait") end = begin + source_.quantity(verb, "s", 0, kLongestScript);
    if (verb.key == "phase") script_.timeline_.addPhase(begin, source_.text(verb));
    if (verb.key == "together") end = playGroup(action, begin);
    checkEnd(action.place, end);
    return end;
  }

  double playGroup(const Action& action, double begin) {
    double end = begin;
    const std::vector<YamlField> items = source_.list(action.verb);
    if (items.empty()) source_.fail(action.verb, "is an empty list; write actions that begin together");
    for (const YamlField& item : items) end = std::max(end, play(readAction(item), begin, true));
    return end;
  }

  double playMove(const Action& action, double begin, bool relative) {
    std::vector<int> joints;
    std::vector<double> targets, distances;
    for (const YamlField& entry : source_.map(action.verb)) {
      const int joint = jointOf(entry);
      const double limit = largestPosition(joint);
      const double value = source_.quantity(entry, jointUnit(joint), -limit, limit);
      const double now = script_.timeline_.jointTarget(joint);
      if (begin < script_.timeline_.jointFreeAt(joint) - kRounding) {
        source_.fail(entry, "begins to move at " + seconds(begin) + ", but an action before still moves it until " +
                                seconds(script_.timeline_.jointFreeAt(joint)) +
                                "; let it end first or delay with 'after'");
      }
      joints.push_back(joint);
      targets.push_back(relative ? now + value : value);
      distances.push_back(std::abs(targets.back() - now));
      if (std::abs(targets.back()) > limit) {
        source_.fail(entry, "leads to " + showQuantity(targets.back(), jointUnit(joint)) + "; stay within " +
                                showQuantity(limit, jointUnit(joint)));
      }
    }
    if (joints.empty()) source_.fail(action.verb, "names no joint; write for example 'move: {insertion: 10 cm}'");
    const double duration = moveDuration(action, distances, joints.front());
    checkEnd(action.place, begin + duration);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const double joint_begin = std::max(begin, script_.timeline_.jointFreeAt(joints[k]));
      script_.timeline_.addMotion(joints[k], joint_begin, begin + duration, targets[k]);
    }
    return begin + duration;
  }

  double moveDuration(const Action& action, const std::vector<double>& distances, int joint) const {
    const YamlField* speed = option(action, "speed");
    const double duration = timeOption(action, "in", kShortestMotion);
    if (speed == nullptr && std::isnan(duration)) {
      source_.fail(action.verb, "does not say how long it takes; write 'in: 2 s' or 'speed: 2 cm/s' beside it");
    }
    if (speed == nullptr) return duration;
    if (!std::isnan(duration)) source_.fail(*speed, "contradicts 'in'; keep one of the two");
    if (distances.size() != 1) source_.fail(*speed, "needs a single joint; write 'in' to move several at once");
    const double limit = isPrismatic(joint) ? 10 : 100;
    const double value = source_.quantity(*speed, jointSpeedUnit(joint), 1e-6, limit);
    return std::max(distances.front() / value, kShortestMotion);
  }

  double playHold(const Action& action, double begin) {
    const int button = buttonOf(action.verb);
    const double duration = timeOption(action, "for", kShortestPress);
    if (std::isnan(duration)) source_.fail(action.verb, "does not say how long; write 'for: 1 s' beside it");
    checkEnd(action.place, begin + duration);
    addEdge(action.verb, button, begin, true);
    addEdge(action.verb, button, begin + duration, false);
    return begin + duration;
  }

  double playEdge(const Action& action, double begin, bool pressed) {
    addEdge(action.verb, buttonOf(action.verb), begin, pressed);
    return begin;
  }

  void addEdge(const YamlField& place, int button, double time, bool pressed) {
    Timeline& timeline = script_.timeline_;
    const std::string name = kButtonNames[button];
    if (timeline.isPressed(button) == pressed) {
      source_.fail(place, "'" + name + "' is already " + (pressed ? "pressed" : "released") + " at " + seconds(time) +
                              "; " + (pressed ? "release it first" : "press it first"));
    }
    if (time < timeline.lastEdge(button) + kShortestPress - kRounding) {
      source_.fail(place, "'" + name + "' changes at " + seconds(time) + ", too soon after " +
                              seconds(timeline.lastEdge(button)) + "; leave at least 0.1 s between");
    }
    timeline.addEdge(button, time, pressed);
  }

  int jointOf(const YamlField& field) const { return indexOf(source_, field, field.key, kJointNames, "joint"); }

  int buttonOf(const YamlField& field) const {
    return indexOf(source_, field, source_.text(field), kButtonNames, "button");
  }

  void checkEnd(const YamlField& place, double end) const {
    if (end > kLongestScript) source_.fail(place, "ends after more than 24 h; shorten the script");
  }
};

TraineeScript TraineeScript::load(const std::string& file) {
  return ScriptReader(YamlSource::load(file, kScriptLimits)).read();
}

TraineeScript TraineeScript::parse(const std::string& yaml, const std::string& place) {
  return ScriptReader(YamlSource::parse(yaml, place, kScriptLimits)).read();
}

}  // namespace vibe
