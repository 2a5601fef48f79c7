#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// Parameters of the tremor that is added to the intended motion.
struct TremorSettings {
  double low_frequency = 8;                     ///< [Hz]
  double high_frequency = 12;                   ///< [Hz]
  std::array<double, kJointCount> amplitude{};  ///< root mean square per joint [m], [rad]
  double scale = 1;                             ///< multiplies all amplitudes (ratio)
};

/// Involuntary movement of the hands: for each joint a sum of sinusoids with frequencies spread over a band and random
/// phases. Physiological tremor of the hand lies at 8 to 12 Hz: Elble & Randall 1976, J Neurophysiol 39(2):370. A pure
/// function of seed and time, with zero mean over long times.
class Tremor {
 public:
  Tremor() = default;
  /// @param seed  of frequencies and phases
  Tremor(const TremorSettings& settings, std::uint64_t seed);

  /// Displacement of a joint at time t [s] in [m] or [rad].
  double at(int joint, double time) const;

 private:
  struct Wave {
    double angular_frequency;  // [rad/s]
    double phase;              // [rad]
    double amplitude;          // [m], [rad]
  };
  std::array<std::vector<Wave>, kJointCount> waves_;
};

/// How well a trainee performs. The defaults describe an experienced endoscopist; novice() a beginner. Values between
/// the two are a learning curve.
struct Skill {
  std::string name = "expert";  ///< for people; it changes nothing
  double pace = 1;              ///< speed of the hand relative to an experienced one
  double look_time = 7;         ///< that is taken to look before each bite [s]
  double foresight = 1;         ///< how well it imagines where the needle will pass when the wall is drawn in, 0 to 1:
                                ///< not beyond what the device looks like now, fully
  double reaction_time = 0.15;  ///< from what is seen or felt to the motion of the hand [s]
  double aim_error = 1e-3;      ///< standard deviation of the place of a bite or mark, per direction [m]
  double force_limit = 5;       ///< at which a motion is stopped [N]
  double turns = 3;             ///< revolutions of the helix
  double drawn = 3e-3;          ///< helix_advance to which it draws the wall in without checks_depth [m]
  int attempts = 5;             ///< per bite or mark
  bool checks_depth = true;     ///< draws the wall in farther if the needle has not penetrated it fully
  double tightness = 1;         ///< part of the tension of a full cinch at which it is released
  /// Of the hands, added to all motions.
  TremorSettings tremor{8, 12, {5e-5, 1.7e-3, 1.7e-3, 1.7e-3, 2e-5, 0, 0}, 1};

  static Skill expert() { return {}; }  ///< the defaults
  static Skill novice();                ///< a beginner: slower, less accurate, rougher, and content with less
};

/// Between two skills: 0: the first, 1: the second.
Skill between(const Skill& first, const Skill& second, double part);

}  // namespace vibe
