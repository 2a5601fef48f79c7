#pragma once
#include <map>
#include <string>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"

namespace vibe::hardware {

/// Reads a PadMapping out of a YAML document.
class PadMappingReader {
 public:
  PadMappingReader(const YamlSource& source, const ToolLimits& limits) : source_(source), limits_(limits) {}
  PadMapping read();

 private:
  const YamlSource& source_;
  const ToolLimits& limits_;
  PadMapping mapping_;
  std::map<std::pair<int, int>, std::string> used_;  // event type and code -> path of the key that uses it

  void readJoints(const YamlField& field);
  void readJoint(const YamlField& field, int joint);
  void readControl(const YamlField& field, const std::vector<YamlField>& entries, JointMapping& joint);
  void readMotion(const YamlField& field, const std::vector<YamlField>& entries, int index, JointMapping& joint);
  void readPosition(const YamlField& field, const std::vector<YamlField>& entries, int index, JointMapping& joint);
  void readButtons(const YamlField& field);
  void readFeedback(const YamlField& field);

  double within(const YamlField& field, const std::string& unit, double low, double high) const;
  int code(const YamlField& field, int type);
  void readPair(const YamlField& field, int type, JointMapping& joint);
  void checkKeys(const std::vector<YamlField>& entries, const std::vector<std::string>& known) const;
};

}  // namespace vibe::hardware
