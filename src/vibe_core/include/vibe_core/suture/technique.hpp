#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace vibe {

/// Stitch pattern that the operator intended with a set of bites. docs/technique.md describes the patterns and where
/// two of them coincide.
enum class Technique : std::uint8_t { Other = 0, U = 1, Z = 2, Triangular = 3, Square = 4, Running = 5, C = 6 };
constexpr int kTechniqueCount = 7;  ///< values of Technique, Other included

/// "other", "u", "z", "triangular", "square", "running", "c".
const char* toString(Technique technique);

/// How a technique is recognised.
enum class TechniqueRule {
  Corrected,  ///< the nearest ideal pattern among those of all techniques
  Printed     ///< equations 1 to 4 of the ViBE paper (section 2.1.3) as printed: U, Z or Other
};

/// Fewest bites of a technique. Sets with less are Other.
constexpr int kTechniqueMinBites = 4;
constexpr int kTechniqueMaxBites = 16;  ///< most bites; sets with more are Other

struct TechniqueResult {
  Technique technique = Technique::Other;  ///< that was recognised; Other: none

  /// Confidence of the result, from 0 (another technique is equally likely) to 1. Corrected: tanh(d / 4), where d
  /// is the misfit of the closest alternative minus that of the result. This is the difference of the two probabilities
  /// if there were no third technique. Other counts as an alternative; its misfit is the threshold above which a set is
  /// Other. Printed: the smallest distance of a dot product from its threshold, at most 1.
  double margin = 0;

  /// Corners of a U or Z. Transition i lies between bite vectors i and i + 1 (vector i runs from bite i to bite i + 1),
  /// and therefore at bite i + 1. -1: none, as always for the other techniques.
  std::array<int, 2> transitions{-1, -1};
};

/// Recognises the technique of one suture set from the current positions of its bites [m], in the order in which they
/// were made. Never fails: a number of bites outside the limits above, bites that all coincide, or a position that is
/// not finite give Other with margin 0. The result is invariant under translation, rotation, reflection and uniform
/// scaling. Corrected is also invariant under reversal of the order; Printed reads the same dot products backwards.
TechniqueResult recogniseTechnique(const std::vector<Eigen::Vector3d>& bites,
                                   TechniqueRule rule = TechniqueRule::Corrected);

}  // namespace vibe
