#include "vibe_core/trainee/trainee_script.hpp"

#include <algorithm>

#include "trainee/script_reader.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe {
namespace {

/// Room for the maximum number of actions that the reader accepts.
constexpr YamlLimits kScriptLimits{16u << 20, 32};

}  // namespace

TraineeScript TraineeScript::load(const std::string& file) {
  const YamlSource source = YamlSource::load(file, kScriptLimits);
  return ScriptReader(source).read();
}

TraineeScript TraineeScript::parse(const std::string& yaml, const std::string& place) {
  const YamlSource source = YamlSource::parse(yaml, place, kScriptLimits);
  return ScriptReader(source).read();
}

StepInput TraineeScript::at(double time) const {
  const double t = time > 0 ? std::min(time, duration()) : 0;  // also for NaN
  StepInput input;
  for (int joint = 0; joint < kJointCount; ++joint) {
    input.joints[joint] = timeline_.position(joint, t) + tremor_.at(joint, t);
  }
  for (int button = 0; button < kButtonCount; ++button) input.buttons[button] = timeline_.pressed(button, t) ? 1 : 0;
  return input;
}

const std::string& TraineeScript::phaseAt(double time) const {
  return timeline_.phase(time > 0 ? std::min(time, duration()) : 0);
}

}  // namespace vibe
