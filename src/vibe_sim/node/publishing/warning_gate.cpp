#include "publishing/warning_gate.hpp"

#include <cstring>
#include <iterator>

namespace vibe::sim {
namespace {

/// Without numbers, and without what stands between a quotation mark after a space and the next mark.
std::string withoutWhatVaries(const std::string& sentence) {
  std::string kind;
  bool quoted = false;
  char last = ' ';
  for (const char c : sentence) {
    if (c == '\'' && (quoted || last == ' ')) quoted = !quoted;
    if (!quoted && std::strchr("0123456789.+-", c) == nullptr) kind += c;
    last = c;
  }
  return kind;
}

}  // namespace

bool WarningGate::admits(const std::string& sentence, double now) {
  for (auto each = told_.begin(); each != told_.end();)
    each = now - each->second >= kWarningPeriod ? told_.erase(each) : std::next(each);
  return told_.size() < kMostWarnings && told_.try_emplace(withoutWhatVaries(sentence), now).second;
}

}  // namespace vibe::sim
