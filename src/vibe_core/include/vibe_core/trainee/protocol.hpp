#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_core/trainee/goal.hpp"
#include "vibe_core/trainee/skill.hpp"

namespace vibe {

/// What a trainee that looks is to do, and how well. docs/protocols.md describes the format.
struct Protocol {
  std::string name;
  Skill skill;
  std::uint64_t seed = 1;  ///< of aim errors and tremor
  std::vector<Goal> goals;

  /// @throws Error with file, line and remedy for input that does not follow the format
  static Protocol load(const std::string& file);
  static Protocol parse(const std::string& yaml, const std::string& place);
};

/// Whether a file is a protocol, that is, has a key `goals`, rather than a trainee script.
/// @throws Error if it cannot be read
bool isProtocol(const std::string& file);

}  // namespace vibe
