#pragma once
#include <map>
#include <string>

namespace vibe::sim {

/// Between warnings of a kind [s].
constexpr double kWarningPeriod = 1;
/// Kinds that may be told within that time.
constexpr std::size_t kMostWarnings = 50;

/// Keeps a flood of wrong messages from becoming a flood of sentences: of each kind one passes in kWarningPeriod, and
/// of all kinds kMostWarnings. Sentences are of one kind if they differ in numbers and in what is quoted only.
class WarningGate {
 public:
  /// @param now  steady time [s]
  bool admits(const std::string& sentence, double now);

 private:
  std::map<std::string, double> told_;  // by kind; steady time [s]
};

}  // namespace vibe::sim
