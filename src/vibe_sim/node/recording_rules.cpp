#include "recording_rules.hpp"

#include <algorithm>

namespace vibe::sim {

// The periods keep enough to look at a session with rosbag play and to plot it without a replay.
const std::vector<RecordingRule>& recordingRules() {
  static const std::vector<RecordingRule> rules = {
      {"tissue/particles", 2, true},
      {"sutures", 2, true},
      {"tissue/pull_state", 0.1, true},
      {"scope/measured_cp", 0.1, true},
      {"scope/measured_cf", 0.1, true},
      {"joint_states", 0.1, true},
      {"overstitch/helix/measured_cp", kNever, true},
      {"scope/setpoint_js", kNever, true},
      {"scope/simulated/measured_js", kNever, true},
      {"overstitch/simulated/measured_js", kNever, true},
      {"scope/jacobian", kNever, true},
      {"wall/measured_cp", kNever, true},
      {"haptic/parameters", kNever, true},
      {"step_result", kNever, true},
      {"step_timing", kNever, true},
      {"/clock", 0.1, true},
      {"type:tf2_msgs/TFMessage", kNever, false},
      {"type:sensor_msgs/Image", kNever, false},
      {"type:sensor_msgs/CompressedImage", kNever, false},
      {"type:sensor_msgs/CameraInfo", kNever, false},
  };
  return rules;
}

bool isTopic(const std::string& topic, const std::string& name) {
  if (topic == name) return true;
  return topic.size() > name.size() && topic.compare(topic.size() - name.size(), name.size(), name) == 0 &&
         topic[topic.size() - name.size() - 1] == '/';
}

const RecordingRule* recordingRule(const std::string& topic, const std::string& type,
                                   const std::set<std::string>& prefixes) {
  // the frames of what stands still are sent once and are small
  if (isTopic(topic, "tf_static")) return nullptr;
  const auto& rules = recordingRules();
  const auto is_of_simulator = [&](const std::string& name) {
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const std::string& prefix) { return topic == prefix + name; });
  };
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const RecordingRule& rule) {
    if (rule.topic.rfind("type:", 0) == 0) return rule.topic.substr(5) == type;
    return rule.topic[0] == '/' ? topic == rule.topic : is_of_simulator(rule.topic);
  });
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace vibe::sim
