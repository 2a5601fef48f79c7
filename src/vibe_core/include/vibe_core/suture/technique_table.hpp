#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// Reads suture sets from a text file with one row `x,y,z` per bite, in any unit of length, and a blank line between
/// sets. '#' begins a comment, also after a row. A line with only a comment does not end a set. The first row may be a
/// header; its names x, y and z then select the columns, and other columns are ignored.
/// @param name  of the file, for messages
/// @throws vibe::Error  `name:line` and the reason: too few or too many columns, a value that is not a finite number, a
///         header without x, y or z, no bite at all, or a read error
std::vector<std::vector<Eigen::Vector3d>> readTechniqueCsv(std::istream& in, const std::string& name);

constexpr int kTableMinBites = 4;  ///< fewest bites of a set in a table
constexpr int kTableMaxBites = 9;  ///< most bites of a set in a table

/// Confusion table: how often a rule assigned each technique to the patterns of a technique.
struct TechniqueTable {
  /// [bites - kTableMinBites][drawn][recognised], both as Technique
  std::array<std::array<std::array<int, kTechniqueCount>, kTechniqueCount>, kTableMaxBites - kTableMinBites + 1>
      count{};

  /// Share of correct answers; 0: there are none. three_way: Triangular, Square, Running, C and Other count as one
  /// answer, as in the paper.
  /// @param bite_count  among the sets of that many bites, kTableMinBites to kTableMaxBites; empty: among all
  double right(bool three_way, std::optional<int> bite_count = std::nullopt) const;
  int drawn(Technique technique) const;  ///< number of patterns of that technique in the table
};

/// Draws `per_cell` patterns of every technique and number of bites and recognises them.
/// @param noise  see drawTechniquePattern()
TechniqueTable measureTechnique(TechniqueRule rule, double noise, int per_cell, std::uint64_t seed);

/// The tables of both rules without noise and with 0.15, in Markdown.
std::string techniqueReport(int per_cell, std::uint64_t seed);

}  // namespace vibe
