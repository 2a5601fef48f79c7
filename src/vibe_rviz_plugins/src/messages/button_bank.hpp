#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vibe {

/// A command of the trainee's: a button of the topic scope/buttons.
struct Command {
  std::string label, help;
  bool toggles;  ///< stays down until it is pressed again; else it is down only while it is held
};
constexpr int kCommandCount = 6;

/// In the order of the topic: APC pedal, helix grab, needle, T-tag, cinch, insufflate.
const std::array<Command, kCommandCount>& commands();

/// When something is pressed, on the clocks that matter.
struct Moment {
  double wall = 0;         ///< steady clock [s]
  double stamp = 0;        ///< of messages, simulated or wall time [s]
  double step_period = 0;  ///< of the simulator [s]
  std::uint64_t step = 0;  ///< the simulator's, as far as known
  bool paused = false;
};

/// Which buttons are down. A click may be shorter than a step of the simulator, or fall into a pause; it would be lost.
/// A button that was let go therefore stays down until the simulator must have seen it.
class ButtonBank {
 public:
  /// A button of those that toggle changes sides, another goes down.
  void press(int button, const Moment& now);
  /// Of those that toggle nothing happens; another comes up when settle() finds that it was down for long enough.
  void release(int button);
  /// True if a button came up.
  bool settle(const Moment& now);
  /// Takes over the state of the buttons that toggle from somebody else's message; any other size is ignored.
  void adopt(const std::vector<std::int32_t>& buttons);
  /// Everything that is not a toggle comes up at once.
  void liftHeld();

  /// 1: down. What a message has to say.
  const std::array<std::int32_t, kCommandCount>& down() const { return down_; }

 private:
  std::array<std::int32_t, kCommandCount> down_{};
  std::array<bool, kCommandCount> let_go_{};
  std::array<Moment, kCommandCount> pressed_{};
};

}  // namespace vibe
