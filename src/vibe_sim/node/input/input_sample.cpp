#include "input/input_sample.hpp"

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/word_of.hpp"

namespace vibe::sim {

const char* toString(InputChannel channel) {
  return wordOf(channel,
                {"scope/input/joint_states", "suturing_device/input/joint_states", "scope/buttons", "tissue/pull"}, "");
}

bool isOfOneNode(const SampleSender* a, const SampleSender* b) {
  return a == b || (a != nullptr && b != nullptr && a->node == b->node);
}

std::string topicOf(const InputSample& sample) {
  if (sample.sender != nullptr) return sample.sender->topic;
  const bool scope = sample.channel == InputChannel::Scope;
  const bool twist = sample.target == ScopeTarget::VelocityInWorld || sample.target == ScopeTarget::VelocityInBase;
  return std::string(scope ? "scope/" : "suturing_device/") + (sample.move ? "move_" : "servo_") +
         (sample.target == ScopeTarget::Joints ? "jp"
          : twist                              ? "cv"
                                               : "cp");
}

std::string faultOf(std::int64_t stamp, std::int64_t now, const InputWindow& window) {
  if (stamp == 0) return "";
  const bool early = stamp - now > window.look_ahead;
  const bool late = now - stamp > window.staleness;
  if (!early && !late) return "";
  const double off = 1e-9 * static_cast<double>(early ? stamp - now : now - stamp);
  const double limit = 1e-9 * static_cast<double>(early ? window.look_ahead : window.staleness);
  return formatted("its stamp is %.1f s %s the simulator's time, and %.3g s are accepted", off,
                   early ? "ahead of" : "behind", limit);
}

}  // namespace vibe::sim
