#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::operating {

/// A command of the trainee: a button of the topic scope/buttons.
struct Command {
  std::string label, help;  ///< name of the button; what it does, in a sentence
  bool toggles;             ///< stays down until it is pressed again; otherwise it is down only while held
};
constexpr int kCommandCount = 6;  ///< of commands()

/// In the order of the topic: APC pedal, helix grab, needle, T-tag, cinch, insufflate.
const std::array<Command, kCommandCount>& commands();

/// The time at which a button is pressed, on all clocks in use.
struct Moment {
  double wall = 0;         ///< steady clock [s]
  double stamp = 0;        ///< of messages, simulated or wall time [s]
  double step_period = 0;  ///< of the simulator [s]
  std::uint64_t step = 0;  ///< of the simulator, as far as known
  bool paused = false;     ///< the simulator takes no steps
};

/// Which buttons are down. A click that is shorter than a step of the simulator, or that falls into a pause, would be
/// lost. A released button therefore stays down until the simulator must have seen it.
class ButtonBank {
 public:
  /// A toggle button changes its state, any other goes down.
  void press(int button, const Moment& now);
  /// Has no effect on toggle buttons; any other comes up when settle() finds that it was down for long enough.
  void release(int button);
  /// True if a button came up.
  bool settle(const Moment& now);
  /// Takes over the state of the toggle buttons from the message of another publisher; a wrong size is ignored.
  void adopt(const std::vector<std::int32_t>& buttons);
  /// All buttons that are not toggles come up at once.
  void liftHeld();

  /// 1: down, as in the message.
  const std::array<std::int32_t, kCommandCount>& down() const { return down_; }

 private:
  std::array<std::int32_t, kCommandCount> down_{};
  std::array<bool, kCommandCount> let_go_{};
  std::array<Moment, kCommandCount> pressed_{};
};

}  // namespace vibe::operating
