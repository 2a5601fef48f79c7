#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

constexpr int kTableMinBites = 4;
constexpr int kTableMaxBites = 9;

/// Confusion table: how often a rule assigned each technique to the patterns of a technique.
struct TechniqueTable {
  /// [bites - kTableMinBites][drawn][recognised], both as Technique
  std::array<std::array<std::array<int, kTechniqueCount>, kTechniqueCount>, kTableMaxBites - kTableMinBites + 1>
      count{};

  /// Share of correct answers [1]. three_way: Triangular, Square, Running, C and Other count as one answer, as in the
  /// paper.
  double right(bool three_way) const;
  double right(bool three_way, int bite_count) const;
  int drawn(Technique technique) const;
};

/// Draws `per_cell` patterns of every technique and number of bites and recognises them.
/// @param noise  see drawTechniquePattern()
TechniqueTable measureTechnique(TechniqueRule rule, double noise, int per_cell, std::uint64_t seed);

/// The tables of both rules without noise and with 0.15, in Markdown.
std::string techniqueReport(int per_cell, std::uint64_t seed);

}  // namespace vibe
