#pragma once
#include <functional>
#include <set>
#include <string>

#include "vibe_hardware/crtk/teleop_mapping.hpp"

namespace vibe::hardware {

/// What lies between crtk_teleop and an arm. Messages of one direction keep their order.
struct ArmLink {
  double measurements = 0;  ///< delay of a measurement [s]
  double forces = 0;        ///< delay of a force [s]
  double jitter = 0;        ///< by which a message may come earlier; uniform, no earlier than at once [s]
  double loss = 0;          ///< share of the messages that are lost, 0 to 1
  double outage = 0;        ///< for which nothing gets through, once in 2 s [s]
  unsigned seed = 1;        ///< of jitter and loss
};

/// A hand at the arm: the next place, of time, place, velocity (which it changes) and the force that acts now, after
/// kArmLoopStep. [s], [m], [m/s], [N]
using HandAtArm = std::function<double(double time, double place, double& velocity, double force)>;
constexpr double kArmLoopStep = 1e-4;  ///< [s]

/// A hand that moves as it wants, whatever it feels.
HandAtArm swayingHand(double amplitude, double frequency);
/// A light hand, 0.1 kg on a soft spring, that goes where it intends as far as forces let it.
HandAtArm lightHand(double amplitude, double frequency);
/// A hand that knows the force and yields to it at 0.5 m/s, and does not turn round within 20 ms.
HandAtArm yieldingHand(double range);

/// An arm that moves the insertion against a tissue that is a spring.
struct ArmLoopSettings {
  TeleopMapping mapping;   ///< moves the insertion along an axis of the hand
  ArmLink link;            ///< the way of its messages, both ways
  HandAtArm hand;          ///< who holds it
  double stiffness = 300;  ///< of the tissue [N/m]
  double duration = 10;    ///< [s]
};

/// The energy at the port, and what crtk_teleop would have said.
struct ArmLoopResult {
  double most = 0;                 ///< that the arm gave to the hand within any interval [J]
  double beyond = 0;               ///< the bound of docs/hardware.md, by at most this; negative: never beyond it [J]
  double error = 0;                ///< root mean square of the force that acted less that of the tissue there [N]
  std::set<std::string> warnings;  ///< delay, timeout, silent, overdrawn, held back
};

/// Plays crtk_teleop's step() with an arm that measures 1,000 times a second, keeps the last force that it got, and is
/// reached over the link. A function of its arguments. @throws Error if the mapping does not move the insertion so
ArmLoopResult runArmLoop(const ArmLoopSettings& settings);

}  // namespace vibe::hardware
