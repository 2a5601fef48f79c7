#pragma once
#include <functional>
#include <string>

#include "vibe_core/trainee/script_recorder.hpp"

namespace vibe {

/// How a trainee performs an endoscopic sleeve gastroplasty. The defaults describe an experienced operator.
struct EsgStyle {
  int sets = 6;   ///< 4 to 8 sutures are usual
  int bites = 7;  ///< per set; 6 to 9 are usual
  bool distal_first = true;
  double spread = 1.0;     ///< angle from the greater curvature to the outer bites [rad]
  double pace = 1;         ///< speed of the hand relative to an experienced operator [1]
  double aim_error = 0;    ///< standard deviation of the positions of bites and marks [m]
  double turns = 3;        ///< revolutions of the helix
  double drawn = 5e-3;     ///< distance of the helix from the device when the arm closes [m]
  int attempts = 3;        ///< per bite
  bool looks = true;       ///< pulls the wall in farther if the needle has not penetrated it fully
  int marks = 4;           ///< per line; 0: none
  double mark_spread = 0;  ///< angle from the greater curvature to the outer lines; 0: as for the bites [rad]
  double mark_time = 2;    ///< time that the pedal is pressed [s]
  double burn_time = 0;    ///< the same at one of the marks; 0: as at the others [s]
  int burnt_mark = 0;      ///< index of that mark, in the order of marking, from 0
  int only_set = 0;        ///< number of the only set to sew, from 1; 0: all sets
  double cinch_part = 1;   ///< fraction of the time that the cinch needs to reach its tension [1]
  bool mistakes =
      false;  ///< holds the beam too long on one spot, requests the cinch before the T-tag, and similar errors
  std::uint64_t seed = 1;  ///< of the aim error
};

/// Performs the procedure on the model of the rehearsal: insufflation, marks along the anterior wall, the greater
/// curvature and the posterior wall, then for each set bites in the shape of a U, T-tag and cinch, and finally
/// withdrawal. The model needs a scope, gas, helix and suture. Without marking, the marks are omitted.
/// @param progress  receives a description of the current activity
/// @throws Error if the scene lacks a required part
void performEsg(const EsgStyle& style, ScriptRecorder& rehearsal,
                const std::function<void(const std::string&)>& progress);

}  // namespace vibe
