#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace vibe::graphics {

/// A bite of the needle in the wall.
struct SutureBite {
  Eigen::Vector3d place;   ///< [m]
  bool full_thickness;     ///< through the whole wall
  Eigen::Vector3d inward;  ///< approximate unit vector from the wall into the lumen; zero: unknown
};

/// How far a set is, in the order of vibe_msgs/Suture: bites are taken, the T-tag is dropped, the cinch draws thread,
/// it holds the thread for ever, the thread is broken or torn out.
enum class SutureStage { Open, Tagged, Cinching, Cinched, Broken };

/// The thread between two bites.
struct ThreadPiece {
  std::vector<Eigen::Vector3d> line;  ///< from bite to bite [m]
  double tension = 0;                 ///< 0: slack [N]
};

/// One thread with everything that is drawn of it, checked.
struct SutureSet {
  SutureStage stage = SutureStage::Open;  ///< of the thread
  std::vector<SutureBite> bites;          ///< that hold, in the order in which they were taken
  std::vector<ThreadPiece> pieces;        ///< from bite to bite; empty if there is no thread to draw

  std::string technique;  ///< recognised when the T-tag was dropped; empty before
  double margin = 0;      ///< of the technique, 0 to 1
  std::vector<std::size_t>
      corners;  ///< bites at corners of the pattern; empty if there are none or bites have torn out
  /// Pairs of bites that the technique brings together: the legs of a U, the diagonals of a Z, otherwise each bite and
  /// the next. Empty before the technique is recognised.
  std::vector<std::pair<std::size_t, std::size_t>> links;

  bool has_t_tag = false, has_cinch = false, loose = false;  ///< ends that are there; cinched with too little tension
  Eigen::Vector3d t_tag, cinch;                              ///< [m]
  std::size_t tear_outs = 0;                                 ///< bites that tore out
};

/// A site of bleeding, present or past.
struct Wound {
  Eigen::Vector3d place;   ///< [m]
  Eigen::Vector3d inward;  ///< approximate unit vector from the wall into the lumen; zero: unknown
  bool brisk = false;      ///< it does not stop by itself; drawn as a jet
  double rate = 0;         ///< 0: stopped [m^3/s]
  double amount = 0;       ///< lost so far [m^3]
  double age = 0;          ///< since the start [s]
  int number = 0;          ///< makes the shapes of wounds differ
};

/// All threads and bleeding of one message, with positions in its frame.
struct SutureDrawing {
  std::vector<SutureSet> sets;  ///< in the order of the message, which gives them their numbers
  std::vector<Wound> wounds;    ///< in the order of the message
};

}  // namespace vibe::graphics
