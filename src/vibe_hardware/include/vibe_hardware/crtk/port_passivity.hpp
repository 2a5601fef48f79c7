#pragma once
#include <array>
#include <cstddef>

namespace vibe::hardware {

// Passivity of one coordinate of an arm that takes forces from far away: an observer of the energy that the force may
// have given to the hand, and a controller that takes force away before the energy runs out (time-domain passivity;
// Hannaford and Ryu, IEEE Transactions on Robotics and Automation 18(1), 2002; with delay: Ryu, Artigas and Preusche,
// Mechatronics 20(7), 2010). The second reference needs an observer at the arm, too; an arm with a CRTK interface has
// none. So the one here books the worst of what may have happened: in each interval between two measurements the force
// that gives most among all those that may have acted in it.

/// What is known of the port. Lengths in [m] and forces in [N], or angles in [rad] and torques in [N m].
struct PortConfig {
  double delay = 0.01;       ///< from sending a force until the arm applies it, at most [s]
  double hold = 0.02;        ///< between two commands, at most [s]
  double speed_limit = 0.5;  ///< that the hand does not exceed [m/s], [rad/s]
  double resolution = 6e-5;  ///< step of the measured coordinate [m], [rad]
  double force_limit = 3;    ///< of what is sent [N], [N m]
  double damping_limit = 5;  ///< most damping that is added [N s/m], [N m s/rad]
  double capacity = 0.05;    ///< energy that the port gives beyond what the hand has put in, at most [J]
};

/// Commands that may act from `begin` on: until the next one begins and `delay` longer.
struct PortCommand {
  double begin = 0;          ///< [s]
  double low = 0, high = 0;  ///< of the forces; equal but for merged ones [N], [N m]
};

/// In which what was booked for silence comes back [s]: after silences, and only then, the port gives on average up to
/// capacity / kReturnTime more. Design choice: longer than a person waits for an oscillation, shorter than for a force.
constexpr double kReturnTime = 1.5;

/// What an observer knows and remembers; begun by startPort().
struct PortState {
  static constexpr std::size_t kCommands = 256;  ///< beyond, the oldest two are merged

  double balance = 0;                             ///< energy that may still be given [J]
  double suspended = 0;                           ///< booked for what nobody saw; comes back with time [J]
  double time = 0;                                ///< of the last measurement [s]
  double position = 0;                            ///< at that time [m], [rad]
  double velocity = 0;                            ///< low-pass filtered [m/s], [rad/s]
  double charged = 0;                             ///< force that was booked last [N], [N m]
  bool measured = false;                          ///< whether there is a measurement
  bool released = false;                          ///< the last command was release()
  bool acts = false;                              ///< the last command was lowered
  double withheld = 0;                            ///< share of the last spring force that was not sent
  std::array<PortCommand, kCommands> commands{};  ///< on their way or acting, oldest first; the first `count` are valid
  std::size_t count = 1;                          ///< of commands; the first is 0 since ever
};

/// The beginning: a full account, and no force. @param now [s]
PortState startPort(const PortConfig& config, double now);

/// Books the motion since the last measurement. A time that is not after the last one is ignored.
/// @param time  at which the arm measured, of the same clock as those of the commands [s]
void observe(const PortConfig& config, double time, double position, PortState& state);

/// Goes on from a position after an unknown motion: after silence, or after a jump of the frame of reference. Books all
/// energy that was reserved until then. Nobody knows whether it was given, so it comes back at the rate of the capacity
/// in kReturnTime.
void rebase(const PortConfig& config, double time, double position, PortState& state);

/// What may be sent now instead of spring + damping. While the hand is no faster than the speed limit and delay and
/// hold keep their bounds, the balance never falls below 0, whatever the delay is and whatever comes next. The emptier
/// the account, the more damping is added; its last tenth is reserved for damping, so that the hand can fill it again.
/// @param spring   force that does not depend on the velocity
/// @param damping  B of the tissue: the force is spring - B v
/// @return the force to send, which counts as sent
double command(const PortConfig& config, double now, double spring, double damping, PortState& state);

/// Sends no force, which is always possible. When none acts any more, all that was booked is suspended. @return 0
double release(double now, PortState& state);

}  // namespace vibe::hardware
