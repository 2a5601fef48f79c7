#pragma once
#include <functional>
#include <string>

#include "vibe_core/trainee/script_recorder.hpp"

namespace vibe {

/// How a trainee performs an endoscopic sleeve gastroplasty. The defaults are an experienced one.
struct EsgStyle {
  int sets = 6;   ///< 4 to 8 sutures are usual
  int bites = 7;  ///< per set; 6 to 9 are usual
  bool distal_first = true;
  double spread = 1.0;     ///< angle from the greater curvature to the outer bites [rad]
  double pace = 1;         ///< of the hand [1]
  double aim_error = 0;    ///< standard deviation of where bites and marks are put [m]
  double turns = 3;        ///< of the helix
  double drawn = 5e-3;     ///< how far out of the device the helix stays when the arm closes [m]
  int attempts = 3;        ///< at a bite
  bool looks = true;       ///< draws the wall in farther where the needle has not gone through all of it
  int marks = 4;           ///< per line; 0: none
  double mark_spread = 0;  ///< angle from the greater curvature to the outer lines; 0: that of the bites [rad]
  double mark_time = 2;    ///< that the pedal is held [s]
  double burn_time = 0;    ///< that it is held at one of the marks instead; 0: no longer than at the others [s]
  int burnt_mark = 0;      ///< which one, in the order in which they are made, from 0
  int only_set = 0;        ///< of the sets just this one is sewn, from 1; 0: all of them
  double cinch_part = 1;   ///< of the time that the cinch needs for its tension [1]
  bool mistakes = false;   ///< holds the beam too long on one spot, asks for the cinch before the T-tag, and the like
  std::uint64_t seed = 1;  ///< of the aim's error
};

/// Performs the procedure on the rehearsal's model: insufflation, marks along the anterior wall, the greater curvature
/// and the posterior wall, then set by set bites in the shape of a U, T-tag and cinch, and out again. The model needs a
/// scope, gas, helix and suture; marks are left out without marking.
/// @param progress  what is being done, for people
/// @throws Error if the scene lacks a part
void performEsg(const EsgStyle& style, ScriptRecorder& rehearsal,
                const std::function<void(const std::string&)>& progress);

}  // namespace vibe
