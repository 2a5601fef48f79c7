#include "vibe_hardware/driver/message_limiter.hpp"

namespace vibe::hardware {

void MessageLimiter::warn(const std::string& kind, const std::string& sentence, double now) {
  const auto [entry, is_new] = kinds_.try_emplace(kind);
  Kind& state = entry->second;
  if (!is_new && now - state.last < kPeriod) {
    ++state.held_back;
    return;
  }
  const std::string more =
      state.held_back > 0 ? " (" + std::to_string(state.held_back) + " more of this kind since the last message)" : "";
  state = {now, 0, sentence};
  sink_(Severity::Warning, sentence + more);
}

void MessageLimiter::warnOnce(const std::string& kind, const std::string& sentence) {
  const auto [entry, is_new] = kinds_.try_emplace(kind);
  if (!is_new && entry->second.sentence == sentence) return;
  entry->second.sentence = sentence;
  sink_(Severity::Warning, sentence);
}

}  // namespace vibe::hardware
