#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

constexpr int kTableMinBites = 4;
constexpr int kTableMaxBites = 9;

/// How often a rule called patterns of a technique by which name.
struct TechniqueTable {
  /// [bites - kTableLeastBites][drawn][recognised], both as Technique
  std::array<std::array<std::array<int, kTechniqueCount>, kTechniqueCount>, kTableMaxBites - kTableMinBites + 1>
      count{};

  /// Share of right answers [1]; three_way: Triangular, Square, Running, C and Other are one answer, as in the paper.
  double right(bool three_way) const;
  double right(bool three_way, int bite_count) const;
  int drawn(Technique technique) const;
};

/// Draws `per_cell` patterns of every technique and number of bites and has them recognised.
/// @param noise  see drawTechniquePattern()
TechniqueTable measureTechnique(TechniqueRule rule, double noise, int per_cell, std::uint64_t seed);

/// The tables of both rules without noise and with 0.15, in Markdown.
std::string techniqueReport(int per_cell, std::uint64_t seed);

}  // namespace vibe
