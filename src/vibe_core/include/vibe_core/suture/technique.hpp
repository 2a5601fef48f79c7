#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace vibe {

/// What a set of bites was meant to be. What each looks like, and where two are the same: docs/technique.md.
enum class Technique : std::uint8_t { Other = 0, U = 1, Z = 2, Triangular = 3, Square = 4, Running = 5, C = 6 };
constexpr int kTechniqueCount = 7;

/// "other", "u", "z", "triangular", "square", "running", "c".
const char* toString(Technique technique);

enum class TechniqueRule {
  Corrected,  ///< the nearest ideal drawing among those of all techniques
  Printed     ///< equations 1 to 4 of the ViBE paper (section 2.1.3) to the letter: U, Z or Other
};

/// Fewest and most bites that can be a technique; sets outside are Other.
constexpr int kTechniqueMinBites = 4;
constexpr int kTechniqueMaxBites = 16;

struct TechniqueResult {
  Technique technique = Technique::Other;

  /// How far the answer is from changing [1], 0 (it could be another) to 1.
  /// Corrected: tanh(d / 4), d the misfit of the closest rival less that of the answer: the difference of their
  /// probabilities were there no third. Other is a rival too, with the misfit from which on a set is Other.
  /// Printed: the least distance of a dot product from the threshold it was compared with, at most 1.
  double margin = 0;

  /// Corners of a U or Z: transition i lies between bite vectors i and i + 1 (vector i runs from bite i to bite
  /// i + 1), hence at bite i + 1. -1: none, as always in the other techniques.
  std::array<int, 2> transitions{-1, -1};
};

/// The technique of one suture set from the present positions of its bites [m], in the order they were made.
/// Total: fewer or more bites than the limits above, bites that coincide all, or a position that is not finite give
/// Other with margin 0. Does not change with translation, rotation, reflection, uniform scale, and reversal of order
/// (the last for Corrected; Printed reads the same dot products backwards).
TechniqueResult recogniseTechnique(const std::vector<Eigen::Vector3d>& bites,
                                   TechniqueRule rule = TechniqueRule::Corrected);

}  // namespace vibe
