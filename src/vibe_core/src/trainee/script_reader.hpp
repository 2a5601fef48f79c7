#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe {

/// Converts the YAML of a trainee script into its timeline. Format: docs/trainee_scripts.md.
class ScriptReader {
 public:
  explicit ScriptReader(const YamlSource& source) : source_(source) {}

  /// @throws Error "file:line: key: what is wrong; remedy"
  TraineeScript read();

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

  void readStart(const YamlField& field);
  TremorSettings readTremor(const YamlField& field) const;
  void readTremorBand(const YamlField& field, TremorSettings& settings) const;
  void readActions(const YamlField& field);

  Action readAction(const YamlField& item) const;
  const YamlField* option(const Action& action, const char* key) const;
  double timeOption(const Action& action, const char* key, double low) const;

  /// Each takes the start time of the action and returns its end time [s].
  double play(const Action& action, double begin, bool in_group);
  double playGroup(const Action& action, double begin);
  double playMove(const Action& action, double begin, bool relative);
  double playHold(const Action& action, double begin);
  double playEdge(const Action& action, double begin, bool pressed);

  double moveDuration(const Action& action, const std::vector<double>& distances, int joint) const;
  void addEdge(const YamlField& place, int button, double time, bool pressed);
  int jointOf(const YamlField& field) const;
  int buttonOf(const YamlField& field) const;
  void checkEnd(const YamlField& place, double end) const;
};

}  // namespace vibe
