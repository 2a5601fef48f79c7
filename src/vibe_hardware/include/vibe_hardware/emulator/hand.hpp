#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe::hardware {

/// What a hand intends at one time. The device follows as far as its mechanics and the forces allow.
struct HandSample {
  std::array<double, kJointCount> joints{};          ///< in the order of vibe::Joint [m], [rad]
  std::array<std::uint8_t, kButtonCount> buttons{};  ///< in the order of vibe::Button; 1 while pressed
};

/// A hand that moves an endoscope by itself. A pure function of time: at(t) gives the same values on every call.
class Hand {
 public:
  virtual ~Hand() = default;

  /// @param time  since the start [s]; from 0
  virtual HandSample at(double time) const = 0;

  /// After this time nothing changes any more [s]; infinite for a hand that never ends.
  virtual double duration() const = 0;
};

/// Between which limits a random hand moves a joint.
struct RandomRange {
  double low = 0, high = 0;  ///< [m], [rad]
  double speed = 0;          ///< never exceeded after the start [m/s], [rad/s]
};

/// The scope within the stomach. Speeds are below those of the endoscope's joints (URDF).
constexpr std::array<RandomRange, kScopeJointCount> kRandomRanges{
    {{0, 0.2, 0.1}, {-2, 2, 2}, {-1, 2, 2}, {-1.2, 1.2, 2}}};

/// Wanders about at random: each joint is a sum of sinusoids with frequencies of 0.05 to 0.5 Hz and random phases,
/// scaled so that it stays within its range and below its speed at all times. In the first two seconds it leaves 0.
/// Buttons are pressed for 0.3 to 2 s at random times. A pure function of seed and time; the same on every machine with
/// the same libm. Never ends.
class RandomHand : public Hand {
 public:
  /// @param ranges  by vibe::Joint; a speed below what the range needs makes the motion smaller
  explicit RandomHand(std::uint64_t seed, const std::array<RandomRange, kScopeJointCount>& ranges = kRandomRanges);

  HandSample at(double time) const override;
  double duration() const override;

 private:
  struct Wave {
    double frequency;  // [rad/s]
    double phase;      // [rad]
    double amplitude;  // [m], [rad]
  };
  std::uint64_t seed_;
  std::array<double, kScopeJointCount> middle_{};
  std::array<std::vector<Wave>, kScopeJointCount> waves_;
};

/// Plays a trainee script: the motions of all joints, with their tremor, and the buttons, as vibe_trainee does.
class ScriptedHand : public Hand {
 public:
  explicit ScriptedHand(TraineeScript script) : script_(std::move(script)) {}  ///< of a valid script

  HandSample at(double time) const override;
  double duration() const override { return script_.duration(); }

 private:
  TraineeScript script_;
};

/// When a hand blinks.
struct BlinkSetup {
  int count = 1000;        ///< of jumps, to and fro together
  std::uint64_t seed = 1;  ///< of the times
  double begin = 3;        ///< first blink, at least this long after the end of the other hand [s]
  double shortest = 0.25;  ///< between two blinks, longer than the latency to be measured [s]
  double longest = 0.5;    ///< [s]
  double step = 0.03;      ///< of tip_left_right [rad]
};

/// Another hand whose tip_left_right jumps to and fro at random times, like an LED that blinks: for measuring how long
/// the jump takes to become visible. The times are continuous, so that their phase against every clock of the system is
/// uniform.
class BlinkHand : public Hand {
 public:
  /// @param other  null: a hand that holds still at 0
  /// @throws Error if the other hand never ends, or the times make no sense
  BlinkHand(const BlinkSetup& setup, std::shared_ptr<const Hand> other);

  HandSample at(double time) const override;
  double duration() const override;

  /// Times of the jumps, ascending [s]. The first one goes up, the next down.
  const std::vector<double>& blinks() const { return blinks_; }

 private:
  std::shared_ptr<const Hand> other_;
  double step_;
  std::vector<double> blinks_;
};

/// Writes when each blink of a hand happened and when the report that shows it left the device, as a table with the
/// columns `blink`, `event` and `report`: number from 0, and times of the wall clock [ns].
class BlinkLog {
 public:
  /// @param blinks  times of the hand [s], ascending
  /// @throws Error if the file cannot be written
  BlinkLog(const std::string& file, std::vector<double> blinks);

  /// A tick is over. @param hand  time of the hand at its end [s]  @param wall  the same time on the wall clock [ns]
  void tick(double hand, std::int64_t wall);
  /// A report has left the device. @param wall  [ns]
  void report(std::int64_t wall);

 private:
  std::string file_;
  std::ofstream out_;  // not whole: a log
  std::vector<double> blinks_;
  std::size_t next_ = 0, reported_ = 0;
  std::vector<std::int64_t> events_;
};

}  // namespace vibe::hardware
