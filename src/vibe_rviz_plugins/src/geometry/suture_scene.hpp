#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace vibe {

/// A place where the needle went through the wall.
struct SutureBite {
  Eigen::Vector3d place;   ///< [m]
  bool full_thickness;     ///< through the whole wall
  Eigen::Vector3d inward;  ///< unit, about from the wall into the lumen; zero: not known
};

enum class SutureStage { Open, Tagged, Cinching, Cinched, Broken };

/// The thread between two bites.
struct ThreadPiece {
  std::vector<Eigen::Vector3d> line;  ///< from bite to bite [m]
  double tension = 0;                 ///< 0: slack [N]
};

/// One thread with everything of it that is drawn, checked.
struct SutureSet {
  SutureStage stage = SutureStage::Open;
  std::vector<SutureBite> bites;
  std::vector<ThreadPiece> pieces;

  std::string technique;             ///< recognised when the T-tag was dropped; empty before
  double margin = 0;                 ///< how sure it is, 0 to 1
  std::vector<std::size_t> corners;  ///< bites at which the row turns; empty without or if bites are gone
  /// Pairs of bites between which lie the particles that tissue pulling draws together: the two legs of a U, the two
  /// diagonals of a Z, of all others every bite with the next. Empty before the technique is recognised.
  std::vector<std::pair<std::size_t, std::size_t>> links;

  bool has_t_tag = false, has_cinch = false, loose = false;
  Eigen::Vector3d t_tag, cinch;  ///< [m]
  std::size_t tear_outs = 0;
};

/// A place that bleeds or has bled.
struct Wound {
  Eigen::Vector3d place;   ///< [m]
  Eigen::Vector3d inward;  ///< unit, about from the wall into the lumen; zero: not known
  bool brisk = false;
  double rate = 0;    ///< 0: it has stopped [m^3/s]
  double amount = 0;  ///< lost so far [m^3]
  double age = 0;     ///< since it began [s]
  int number = 0;     ///< tells wounds apart, so that no two look the same
};

/// All threads of a session and what bleeds, as one message tells it; all places in its frame.
struct SutureScene {
  std::vector<SutureSet> sets;
  std::vector<Wound> wounds;
};

}  // namespace vibe
