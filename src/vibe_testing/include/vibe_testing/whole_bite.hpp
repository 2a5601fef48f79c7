#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"

namespace vibe::test {

/// What a person knows who drives: the joints, what the tool feels, and what has happened since the beginning.
struct SeenByHand {
  double time = 0;                            ///< simulated [s]
  std::array<double, kJointCount> joints{};   ///< of the tool [m], [rad]
  double force = 0;                           ///< of the tissue on the tool [N]
  double gap = 0;                             ///< from the helix to the wall, when it last found no tissue [m]
  std::array<int, kEventKindCount> events{};  ///< how often, by Event::Kind

  /// How often an event of this kind has happened.
  int count(Event::Kind kind) const { return events.at(static_cast<std::size_t>(kind)); }
};

/// A hand at some device, and the device: what differs between a pad, arms, and a page.
class HandAtDevice {
 public:
  virtual ~HandAtDevice() = default;

  /// Goes on with what it does for a moment: a step of the simulator or so. @return what it sees then
  virtual SeenByHand look() = 0;
  /// From now on moves one joint, and no other, towards where `by` is 0: the faster the further. @param by  [m], [rad]
  virtual void steer(Joint joint, double by) = 0;
  /// What it takes for the simulator to see the button pressed, or not.
  virtual void press(Button button, bool down) = 0;

  int commands = 0;  ///< that the device has sent so far, those aside that say the same as the one before
};

/// A person who takes one bite in the stomach of stomach.yaml, at the greater curvature, with whatever hand: blows up
/// the stomach, comes to the wall until the helix gets hold of it, winds it in, draws the wall in, stitches, and lets
/// go. Waits for what happens, never for a time; gives up after a minute of simulated time without it.
class BiteOperator {
 public:
  /// @param hand  outlives the operator
  explicit BiteOperator(HandAtDevice& hand) : hand_(hand) {}

  /// @return what did not happen; empty: the bite was made and the wall let go
  std::string bite() {
    seen_ = hand_.look();
    begin_ = seen_.time;
    hold(Insufflate, true);
    reach(Insertion, 0.08);
    reach(Rotation, -M_PI / 2);
    reach(TipUpDown, 0.5236);
    reach(HelixAdvance, 0.028);
    await("a stomach that is blown up", [this] { return happened(Event::Kind::PressureReached); });
    grab();
    move(HelixRotation, 60, "a helix that is wound in", [this] { return happened(Event::Kind::HelixTurned); });
    reach(HelixAdvance, 0.003);
    move(NeedleDriver, 0.018, "a needle in the wall", [this] { return happened(Event::Kind::Pierced); });
    hold(Needle, true);
    await("a bite", [this] { return happened(Event::Kind::Bite); });
    hold(Needle, false);
    reach(NeedleDriver, 0);
    reach(HelixAdvance, 0.025);
    hold(HelixGrab, false);
    await("a wall that is let go", [this] { return happened(Event::Kind::Release); });
    return failure_;
  }

  /// At the last look.
  const SeenByHand& seen() const { return seen_; }
  double seconds() const { return seen_.time - begin_; }  ///< simulated, of the bite so far [s]
  double force() const { return force_; }                 ///< largest so far [N]

 private:
  static constexpr double kPatience = 60;       // [s]
  static constexpr double kWithinReach = 3e-3;  // of the helix; it has 4 mm [m]
  static constexpr int kTries = 20;             // to get hold of the wall

  HandAtDevice& hand_;
  SeenByHand seen_;
  double begin_ = 0, force_ = 0;
  std::string failure_;  // the first one; then nothing more is done

  bool happened(Event::Kind kind) const { return seen_.count(kind) > 0; }

  void look() {
    seen_ = hand_.look();
    force_ = std::max(force_, seen_.force);
  }

  /// @param act  before each look
  bool await(
      const std::string& what, const std::function<bool()>& come, const std::function<void()>& act = [] {}) {
    const double end = seen_.time + kPatience;
    while (failure_.empty() && !come()) {
      if (seen_.time > end) failure_ = "there was no " + what;
      act();
      look();
    }
    return failure_.empty();
  }

  void move(Joint joint, double target, const std::string& what, const std::function<bool()>& come) {
    await(what, come, [&] { hand_.steer(joint, target - seen_.joints.at(joint)); });
    hand_.steer(joint, 0);
  }

  void reach(Joint joint, double target) {
    const double near = joint == Insertion || joint == HelixAdvance || joint == NeedleDriver ? 1e-3 : 0.02;
    move(joint, target, std::string("way of ") + kJointNames.at(joint) + " to its place",
         [this, joint, target, near] { return std::abs(target - seen_.joints.at(joint)) < near; });
  }

  void hold(Button button, bool down) {
    if (failure_.empty()) hand_.press(button, down);
    look();
  }

  /// Where the helix finds no tissue, the simulator says how far that is, so the scope goes on by as much, and not
  /// beyond.
  void grab() {
    for (int missed = 0; failure_.empty() && missed < kTries; ++missed) {
      hold(HelixGrab, true);
      await("answer of the helix",
            [&] { return happened(Event::Kind::Grab) || seen_.count(Event::Kind::GrabMissed) > missed; });
      if (happened(Event::Kind::Grab)) return;
      hold(HelixGrab, false);
      reach(Insertion, seen_.joints[Insertion] + std::max(seen_.gap - kWithinReach, 1.5e-3));
    }
    if (failure_.empty()) failure_ = "there was no hold for the helix";
  }
};

}  // namespace vibe::test
